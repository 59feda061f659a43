/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "c_asking.h"
#include "c_face.h"

/* The cubes are 1 wide: B moved by x is x - 1 away, or 1 - x deep in A. */
static const char* ask_at(const cdprep_hull* cube, double x, cdprep_convex_cache* cache) {
    const cdprep_placement placement = moved_by(x);
    const double gap = x > 1 ? x - 1 : 0;
    cdprep_error error;
    int hit = -1;
    MUST(cdprep_hulls_collide(cube, cube, &placement, cache, &hit, &error) == CDPREP_OK);
    MUST(hit == (x <= 1));

    int found = -1;
    cdprep_distance distance;
    MUST(cdprep_hull_distance(cube, cube, &placement, NULL, cache, &found, &distance, &error) ==
         CDPREP_OK);
    MUST(found == 1 && distance.lower <= gap && distance.upper >= gap);
    MUST(distance.upper - distance.lower < 1e-12 && (distance.lower > 0) == (x > 1));
    MUST(fabs(distance.witness_b[0] - distance.witness_a[0] - gap) < 1e-12);
    MUST(distance.triangle_a == UINT32_MAX && distance.triangle_b == UINT32_MAX);

    /* The tolerance belongs to it, to the last bit. */
    int within = -1;
    MUST(cdprep_hulls_within(cube, cube, &placement, gap, cache, &within, &error) == CDPREP_OK);
    MUST(within == 1);
    MUST(cdprep_hulls_within(cube, cube, &placement, nextafter(gap, -1), cache, &within, NULL) ==
         CDPREP_OK);
    MUST(within == 0);

    cdprep_penetration depth;
    MUST(cdprep_hull_penetration(cube, cube, &placement, NULL, cache, &found, &depth, &error) ==
         CDPREP_OK);
    MUST(found == (x <= 1));
    if (found == 0) return NULL;
    MUST(depth.lower <= 1 - x && depth.upper >= 1 - x - 1e-12 && depth.upper - depth.lower < 1e-12);
    /* In the middle of A all ways out but along x are as long as the cube is wide. */
    if (x > 0 && x < 1) MUST(fabs(depth.normal[0] - 1) < 1e-12 && fabs(depth.normal[1]) < 1e-12);
    MUST(fabs(depth.witness_a[0] - depth.witness_b[0] - depth.upper * depth.normal[0]) < 1e-12);
    return NULL;
}

static const char* ask_options(const cdprep_hull* cube, cdprep_convex_cache* cache) {
    const cdprep_placement far = moved_by(3);
    cdprep_distance_options options = {sizeof options, CDPREP_SURFACE, 0, 0, 1.5};
    cdprep_distance distance;
    int found = -1;
    MUST(cdprep_hull_distance(cube, cube, &far, &options, cache, &found, &distance, NULL) ==
         CDPREP_OK);
    MUST(found == 0 && distance.upper == 0);
    options.max_distance = 2;
    options.absolute_error = 1;
    MUST(cdprep_hull_distance(cube, cube, &far, &options, cache, &found, &distance, NULL) ==
         CDPREP_OK);
    MUST(found == 1 && distance.lower <= 2 && distance.upper >= 2);
    MUST(distance.upper - distance.lower <= 1);
    return NULL;
}

static const char* ask_wrongly(const cdprep_model* model, const cdprep_hull* cube) {
    cdprep_error error;
    cdprep_placement placement = moved_by(0);
    cdprep_hull none = {model, 1234};
    cdprep_hull of_nothing = {NULL, 0};
    cdprep_distance distance;
    cdprep_penetration depth;
    int answer = -1;
    MUST(cdprep_find_hull(model, 4, 0, &answer, &none, &error) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_find_hull(NULL, 0, 0, &answer, &none, NULL) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_find_hull(model, CDPREP_HULL_PART, 0, &answer, &none, NULL) == CDPREP_OK);
    MUST(answer == 0);
    MUST(cdprep_find_hull(model, CDPREP_HULL_INSTANCE, 0, &answer, &none, NULL) == CDPREP_OK);
    MUST(answer == 0);
    MUST(cdprep_hulls_collide(cube, &none, &placement, NULL, &answer, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strstr(error.message, "cdprep_find_hull()") != NULL);
    MUST(cdprep_hulls_collide(&of_nothing, cube, &placement, NULL, &answer, NULL) ==
         CDPREP_BAD_ARGUMENT);
    MUST(cdprep_hulls_collide(cube, cube, &placement, NULL, NULL, NULL) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_hulls_within(cube, NULL, &placement, 1, NULL, &answer, NULL) ==
         CDPREP_BAD_ARGUMENT);
    MUST(cdprep_hull_distance(cube, cube, &placement, NULL, NULL, NULL, &distance, NULL) ==
         CDPREP_BAD_ARGUMENT);
    const cdprep_distance_options no_size = {0, CDPREP_SURFACE, 0, 0, 0};
    MUST(cdprep_hull_penetration(cube, cube, &placement, &no_size, NULL, &answer, &depth, NULL) ==
         CDPREP_BAD_ARGUMENT);
    placement.kind = 9;
    MUST(cdprep_hulls_collide(cube, cube, &placement, NULL, &answer, NULL) == CDPREP_BAD_ARGUMENT);
    return NULL;
}

const char* ask_hulls(const void* bytes, size_t size) {
    cdprep_model* model = NULL;
    MUST(cdprep_open_memory(bytes, size, "cube", &model, NULL) == CDPREP_OK);
    const char* wrong = NULL;
    for (uint32_t scope = CDPREP_HULL_WHOLE; scope <= CDPREP_HULL_COMPONENT; ++scope) {
        cdprep_hull cube;
        int found = 0;
        MUST(cdprep_find_hull(model, scope, 0, &found, &cube, NULL) == CDPREP_OK && found == 1);
        cdprep_convex_cache cache;
        memset(&cache, 0, sizeof cache);
        for (int i = 0; i <= 24 && wrong == NULL; ++i) {
            wrong = ask_at(&cube, i / 8.0, i % 3 == 0 ? NULL : &cache);
        }
        /* Any content of a cache is allowed. */
        memset(&cache, 255, sizeof cache);
        if (wrong == NULL) wrong = ask_at(&cube, 0.5, &cache);
        if (wrong == NULL) wrong = ask_options(&cube, &cache);
        if (wrong == NULL) wrong = ask_wrongly(model, &cube);
    }
    cdprep_close(model);
    return wrong;
}
