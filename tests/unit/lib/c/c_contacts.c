/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "c_api.h"
#include "c_asking.h"

/* The cubes are 1 wide, and B is moved along x: their faces are x - 1 apart. */
static const char* check_contact(const cdprep_contact* contact, double x, int has_points) {
    MUST(contact->piece_a == 0 && contact->piece_b == 0);
    MUST(contact->lower <= x - 1 && contact->upper >= x - 1);
    MUST(contact->upper - contact->lower < 1e-12);
    MUST(contact->flags == (x <= 1 ? CDPREP_CONTACT_OVERLAP : 0U));
    MUST(fabs(contact->normal[0] - 1) < 1e-12);
    MUST(fabs(contact->on_b[0] - contact->on_a[0] - (x - 1)) < 1e-12);
    MUST(contact->feature_a.kind <= CDPREP_FACE && contact->feature_b.kind <= CDPREP_FACE);
    MUST(contact->feature_a.triangle < 12 && contact->feature_b.triangle < 12);
    MUST(contact->feature_a.vertex[0] < 8 && contact->feature_b.vertex[0] < 8);
    MUST(contact->feature_a.vertex[1] == CDPREP_NONE);
    /* In this file every triangle is a face by itself. */
    MUST(has_points ? contact->point_count >= 3 : contact->point_count == 0);
    MUST(contact->point_count <= 4);
    for (uint32_t i = 0; i < contact->point_count; ++i) {
        MUST(fabs(contact->points[i].distance - (x - 1)) < 1e-12);
        MUST(fabs(contact->points[i].on_a[0] - 1) < 1e-12);
        MUST(fabs(contact->points[i].on_b[0] - x) < 1e-12);
    }
    return NULL;
}

struct seen {
    size_t count;
    cdprep_contact last;
};

static int see(void* context, const cdprep_contact* contact) {
    struct seen* seen = (struct seen*)context;
    ++seen->count;
    seen->last = *contact;
    return 0;
}

static const char* ask_at(const cdprep_model* cube, cdprep_workspace* scratch, double x) {
    const cdprep_pair pair = moved_by(cube, cube, x);
    cdprep_contact contact;
    cdprep_contact_list list = {&contact, 1, 9, 9, 9, 9, 9, 9};
    cdprep_contact_options options;
    cdprep_contact_options_init(&options, sizeof options);
    options.tolerance = 0.25;
    MUST(cdprep_contacts(&pair, &options, scratch, &list, NULL) == CDPREP_OK);
    MUST(list.count == (x <= 1.25 ? 1U : 0U) && list.complete == CDPREP_YES);
    if (list.count == 0) return NULL;
    const char* wrong = check_contact(&contact, x, 0);
    if (wrong != NULL) return wrong;
    options.manifold = 4;
    MUST(cdprep_contacts(&pair, &options, scratch, &list, NULL) == CDPREP_OK);
    wrong = check_contact(&contact, x, 1);
    if (wrong != NULL) return wrong;
    list.items = NULL;
    list.room = 0;
    MUST(cdprep_contacts(&pair, &options, scratch, &list, NULL) == CDPREP_OK && list.count == 1);
    struct seen seen;
    seen.count = 0;
    MUST(cdprep_contacts_visit(&pair, &options, scratch, see, &seen, NULL) == CDPREP_OK);
    MUST(seen.count == 1);
    options.work = 1; /* the one pair of near triangles, and no contact */
    MUST(cdprep_contacts(&pair, &options, scratch, &list, NULL) == CDPREP_OK);
    MUST(list.count == 0 && list.complete == CDPREP_NO && list.searched == CDPREP_NO);
    MUST(list.found == 1 && list.computed == 0 && list.work == 1);
    options.work = 0;
    options.most = 0;
    MUST(cdprep_contacts(&pair, &options, scratch, &list, NULL) == CDPREP_BAD_ARGUMENT);
    MUST(list.count == 0 && list.complete == CDPREP_NO);
    return check_contact(&seen.last, x, 1);
}

/* Parallel faces: any part of either may answer, but the gap is known. */
static const char* ask_features(const cdprep_model* model, double x, cdprep_hull_cache* cache) {
    cdprep_closest_features features;
    cdprep_hull_pair pair;
    cdprep_hull_pair_init(&pair, sizeof pair);
    MUST(cdprep_hull_find(model, CDPREP_HULL_PIECE, 0, &pair.a, NULL) == CDPREP_OK);
    pair.b = pair.a;
    pair.cache = cache;
    pair.pose_b.rows[9] = x;
    MUST(cdprep_hulls_features(&pair, &features, NULL) == CDPREP_OK);
    MUST(features.found == (x > 1 ? CDPREP_YES : CDPREP_NO));
    if (features.found == CDPREP_NO) return NULL;
    MUST(features.lower <= x - 1 && features.upper >= x - 1);
    MUST(features.upper - features.lower < 1e-12);
    MUST(features.parallel == CDPREP_YES);
    MUST(fabs(features.on_a[0] - 1) < 1e-12 && fabs(features.on_b[0] - x) < 1e-12);
    const cdprep_feature* both[2] = {&features.a, &features.b};
    for (int side = 0; side < 2; ++side) {
        MUST(both[side]->kind <= CDPREP_FACE);
        for (uint32_t i = 0; i < 3; ++i) {
            MUST(i <= both[side]->kind ? both[side]->vertex[i] < 8
                                       : both[side]->vertex[i] == CDPREP_NONE);
        }
    }
    /* The same hulls, asked as hulls; the cache serves both kinds of questions. */
    cdprep_nearest nearest;
    MUST(cdprep_hulls_distance(&pair, NULL, &nearest, NULL) == CDPREP_OK);
    MUST(nearest.lower <= features.upper && features.lower <= nearest.upper);
    return NULL;
}

static const char* read_piece(const cdprep_model* model) {
    cdprep_hull piece;
    cdprep_error error;
    cdprep_mesh mesh = {NULL, NULL, NULL, 0, 0, 0, 0};
    MUST(cdprep_hull_find(model, CDPREP_HULL_PIECE, 0, &piece, NULL) == CDPREP_OK);
    MUST(cdprep_hull_mesh(&piece, &mesh, NULL) == CDPREP_OK);
    MUST(mesh.vertex_count == 8 && mesh.triangle_count == 12);
    MUST(cdprep_hull_find(model, CDPREP_HULL_PIECE, 1, &piece, NULL) == CDPREP_OK);
    MUST(piece.model == NULL);
    MUST(cdprep_hull_mesh(&piece, &mesh, &error) == CDPREP_BAD_ARGUMENT);
    MUST(strcmp(error.argument, "hull.model") == 0 && mesh.vertex_count == 0);
    return NULL;
}

const char* ask_contacts(const cdprep_model* cube, cdprep_workspace* workspace) {
    const char* wrong = NULL;
    cdprep_hull_cache cache;
    memset(&cache, 0, sizeof cache);
    for (int i = 6; i <= 12 && wrong == NULL; ++i) {
        wrong = ask_at(cube, workspace, i / 8.0);
        if (wrong == NULL) wrong = ask_features(cube, i / 8.0, i % 3 == 0 ? NULL : &cache);
    }
    /* Any content of a cache is allowed. */
    memset(&cache, 255, sizeof cache);
    if (wrong == NULL) wrong = ask_features(cube, 1.5, &cache);
    if (wrong == NULL) wrong = read_piece(cube);
    return wrong;
}
