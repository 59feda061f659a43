/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "c_api.h"
#include "c_asking.h"

/* The cubes are 1 wide: B moved by x is x - 1 away, or 1 - x deep in A. */
static const char* ask_at(const cdprep_hull* cube, double x, cdprep_hull_cache* cache) {
    const double gap = x > 1 ? x - 1 : 0;
    cdprep_error error;
    cdprep_hull_pair pair;
    cdprep_hull_pair_init(&pair, sizeof pair);
    pair.a = pair.b = *cube;
    pair.cache = cache;
    pair.pose_b.rows[9] = x;
    uint32_t hit = CDPREP_UNKNOWN;
    MUST(cdprep_hulls_collide(&pair, &hit, &error) == CDPREP_OK);
    MUST(hit == (x <= 1 ? CDPREP_YES : CDPREP_NO));

    cdprep_nearest nearest;
    MUST(cdprep_hulls_distance(&pair, NULL, &nearest, &error) == CDPREP_OK);
    MUST(nearest.found == CDPREP_YES && nearest.lower <= gap && nearest.upper >= gap);
    MUST(nearest.upper - nearest.lower < 1e-12 && (nearest.lower > 0) == (x > 1));
    MUST(fabs(nearest.on_b[0] - nearest.on_a[0] - gap) < 1e-12);
    MUST(nearest.triangle_a == CDPREP_NONE && nearest.triangle_b == CDPREP_NONE);

    /* The tolerance is inclusive, to the last bit. */
    uint32_t within = CDPREP_UNKNOWN;
    MUST(cdprep_hulls_within(&pair, gap, &within, &error) == CDPREP_OK && within == CDPREP_YES);
    if (gap > 0) {
        MUST(cdprep_hulls_within(&pair, nextafter(gap, 0), &within, NULL) == CDPREP_OK);
        MUST(within == CDPREP_NO);
    }

    cdprep_penetration depth;
    MUST(cdprep_hulls_penetration(&pair, NULL, &depth, &error) == CDPREP_OK);
    MUST(depth.found == (x <= 1 ? CDPREP_YES : CDPREP_NO));
    if (depth.found == CDPREP_NO) return NULL;
    MUST(depth.lower <= 1 - x && depth.upper >= 1 - x - 1e-12 && depth.upper - depth.lower < 1e-12);
    /* In the middle of A all ways out but along x are as long as the cube is wide. */
    if (x > 0 && x < 1) MUST(fabs(depth.normal[0] - 1) < 1e-12 && fabs(depth.normal[1]) < 1e-12);
    MUST(fabs(depth.on_a[0] - depth.on_b[0] - depth.upper * depth.normal[0]) < 1e-12);
    return NULL;
}

static const char* ask_options(const cdprep_hull* cube) {
    cdprep_hull_pair far;
    cdprep_hull_pair_init(&far, sizeof far);
    far.a = far.b = *cube;
    far.pose_b.rows[9] = 3;
    cdprep_distance_options options;
    cdprep_distance_options_init(&options, sizeof options);
    options.max_distance = 1.5;
    cdprep_nearest nearest;
    MUST(cdprep_hulls_distance(&far, &options, &nearest, NULL) == CDPREP_OK);
    MUST(nearest.found == CDPREP_NO && nearest.upper == 0);
    options.max_distance = 2;
    options.absolute_error = 1;
    MUST(cdprep_hulls_distance(&far, &options, &nearest, NULL) == CDPREP_OK);
    MUST(nearest.found == CDPREP_YES && nearest.lower <= 2 && nearest.upper >= 2);
    MUST(nearest.upper - nearest.lower <= 1);
    return NULL;
}

/* A closed surface of 8 corners and 12 triangles around a volume of 1. */
static const char* read_mesh(const cdprep_hull* cube) {
    double positions[24], volume = 0;
    uint32_t triangles[36], vertices[8];
    cdprep_mesh mesh = {positions, triangles, vertices, 8, 12, 0, 0};
    MUST(cdprep_hull_mesh(cube, &mesh, NULL) == CDPREP_OK);
    MUST(mesh.vertex_count == 8 && mesh.triangle_count == 12);
    for (int i = 0; i < 12; ++i) {
        const double *p = positions + 3 * triangles[3 * i],
                     *q = positions + 3 * triangles[3 * i + 1],
                     *r = positions + 3 * triangles[3 * i + 2];
        volume += p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0]) +
                  p[2] * (q[0] * r[1] - q[1] * r[0]);
    }
    MUST(fabs(volume / 6 - 1) < 1e-6);
    return NULL;
}

static const char* ask_wrongly(const cdprep_model* model, const cdprep_hull* cube) {
    cdprep_error error;
    cdprep_hull none;
    cdprep_hull_pair pair;
    uint32_t hit = CDPREP_YES;
    cdprep_closest_features features;
    MUST(cdprep_hull_find(model, 5, 0, &none, &error) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_hull_find(NULL, 0, 0, &none, NULL) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_hull_find(model, CDPREP_HULL_PART, 0, &none, NULL) == CDPREP_OK);
    MUST(none.model == NULL);
    MUST(cdprep_hull_find(model, CDPREP_HULL_INSTANCE, 0, &none, NULL) == CDPREP_OK);
    MUST(none.model == NULL);
    MUST(cdprep_hull_find(model, CDPREP_HULL_PIECE, 0, &none, &error) == CDPREP_BAD_ARGUMENT);
    MUST(error.why == CDPREP_WHY_NOT_BAKED);
    cdprep_hull_pair_init(&pair, sizeof pair);
    pair.a = *cube;
    MUST(cdprep_hulls_collide(&pair, &hit, &error) == CDPREP_BAD_ARGUMENT);
    MUST(strcmp(error.argument, "pair.b.model") == 0 && hit == CDPREP_UNKNOWN);
    pair.b = *cube;
    pair.b.number = 1234;
    MUST(cdprep_hulls_collide(&pair, &hit, &error) == CDPREP_BAD_ARGUMENT);
    MUST(strstr(error.message, "cdprep_hull_find()") != NULL);
    pair.b = *cube;
    MUST(cdprep_hulls_features(&pair, &features, &error) == CDPREP_BAD_ARGUMENT);
    MUST(error.why == CDPREP_WHY_NO_MEANING && features.found == CDPREP_NO);
    return NULL;
}

const char* ask_hulls(const cdprep_model* model) {
    const char* wrong = NULL;
    for (uint32_t scope = CDPREP_HULL_WHOLE; scope <= CDPREP_HULL_COMPONENT; ++scope) {
        cdprep_hull cube;
        cdprep_hull_cache cache;
        MUST(cdprep_hull_find(model, scope, 0, &cube, NULL) == CDPREP_OK && cube.model == model);
        memset(&cache, 0, sizeof cache);
        for (int i = 0; i <= 24 && wrong == NULL; ++i) {
            wrong = ask_at(&cube, i / 8.0, i % 3 == 0 ? NULL : &cache);
        }
        /* Any content of a cache is allowed. */
        memset(&cache, 255, sizeof cache);
        if (wrong == NULL) wrong = ask_at(&cube, 0.5, &cache);
        if (wrong == NULL) wrong = ask_options(&cube);
        if (wrong == NULL) wrong = read_mesh(&cube);
        if (wrong == NULL) wrong = ask_wrongly(model, &cube);
    }
    return wrong;
}
