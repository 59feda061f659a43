/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "c_asking.h"
#include "c_face.h"

/* The cubes are 1 wide, and B is moved along x: their faces are x - 1 apart. */
static const char* check_contact(const cdprep_piece_contact* contact, double x, int has_points) {
    MUST(contact->piece_a == 0 && contact->piece_b == 0);
    MUST(contact->lower <= x - 1 && contact->upper >= x - 1);
    MUST(contact->upper - contact->lower < 1e-12);
    MUST(contact->flags == (x <= 1 ? CDPREP_CONTACT_OVERLAP : 0U));
    MUST(fabs(contact->normal[0] - 1) < 1e-12);
    MUST(fabs(contact->point_b[0] - contact->point_a[0] - (x - 1)) < 1e-12);
    MUST(contact->feature_a.kind <= CDPREP_FACE && contact->feature_b.kind <= CDPREP_FACE);
    MUST(contact->feature_a.triangle < 12 && contact->feature_b.triangle < 12);
    MUST(contact->feature_a.vertex < 8 && contact->feature_b.vertex < 8);
    /* In this file every triangle is a face by itself. */
    MUST(has_points ? contact->point_count >= 3 : contact->point_count == 0);
    MUST(contact->point_count <= CDPREP_MOST_MANIFOLD_POINTS);
    for (uint32_t i = 0; i < contact->point_count; ++i) {
        MUST(fabs(contact->points[i].distance - (x - 1)) < 1e-12);
        MUST(fabs(contact->points[i].on_a[0] - 1) < 1e-12);
        MUST(fabs(contact->points[i].on_b[0] - x) < 1e-12);
    }
    return NULL;
}

struct seen {
    size_t count;
    cdprep_piece_contact last;
};

static int see(void* context, const cdprep_piece_contact* contact) {
    struct seen* seen = (struct seen*)context;
    ++seen->count;
    seen->last = *contact;
    return 0;
}

static const char* ask_at(const cdprep_model* cube, cdprep_workspace* scratch, double x) {
    const cdprep_placement placement = moved_by(x);
    cdprep_piece_contact_options options = {sizeof options, CDPREP_FOUR_POINTS,
                                            CDPREP_KEEP_DEGENERATE};
    cdprep_piece_contact contact;
    cdprep_error error;
    size_t count = 99;
    MUST(cdprep_contacts(cube, cube, &placement, scratch, 0.25, NULL, &contact, 1, &count,
                         &error) == CDPREP_OK);
    MUST(count == (x <= 1.25 ? 1U : 0U));
    if (count == 0) return NULL;
    const char* wrong = check_contact(&contact, x, 0);
    if (wrong != NULL) return wrong;
    MUST(cdprep_contacts(cube, cube, &placement, scratch, 0.25, &options, &contact, 1, &count,
                         &error) == CDPREP_OK);
    wrong = check_contact(&contact, x, 1);
    if (wrong != NULL) return wrong;
    MUST(cdprep_contacts(cube, cube, &placement, scratch, 0.25, &options, NULL, 0, &count, NULL) ==
         CDPREP_OK);
    MUST(count == 1);
    struct seen seen;
    seen.count = 0;
    MUST(cdprep_visit_contacts(cube, cube, &placement, scratch, 0.25, &options, see, &seen, NULL) ==
         CDPREP_OK);
    MUST(seen.count == 1);
    return check_contact(&seen.last, x, 1);
}

/* Parallel faces: any part of either may answer, but the gap is known. */
static const char* ask_features(const cdprep_model* model, double x, cdprep_feature_cache* cache) {
    const cdprep_piece cube = {model, 0};
    const cdprep_placement placement = moved_by(x);
    cdprep_closest_features features;
    int found = -1;
    MUST(cdprep_find_closest_features(&cube, &cube, &placement, cache, &found, &features, NULL) ==
         CDPREP_OK);
    MUST(found == (x > 1));
    if (found == 0) return NULL;
    MUST(features.lower <= x - 1 && features.upper >= x - 1);
    MUST(features.upper - features.lower < 1e-12);
    MUST(features.parallel == 1);
    MUST(fabs(features.witness_a[0] - 1) < 1e-12 && fabs(features.witness_b[0] - x) < 1e-12);
    const cdprep_hull_feature* both[2] = {&features.a, &features.b};
    for (int side = 0; side < 2; ++side) {
        MUST(both[side]->kind <= CDPREP_FACE);
        for (uint32_t i = 0; i < 3; ++i) {
            MUST(i <= both[side]->kind ? both[side]->vertex[i] < 8
                                       : both[side]->vertex[i] == UINT32_MAX);
        }
    }
    return NULL;
}

static const char* ask_wrongly(const cdprep_model* model, cdprep_workspace* scratch) {
    cdprep_placement placement = moved_by(1);
    cdprep_piece_contact contact;
    cdprep_closest_features features;
    cdprep_error error;
    size_t count = 0;
    int found = -1;
    const cdprep_piece cube = {model, 0}, none = {model, 1}, of_nothing = {NULL, 0};
    const cdprep_piece_contact_options no_size = {0, 0, 0};
    MUST(cdprep_contacts(model, model, &placement, scratch, 1, NULL, NULL, 1, &count, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(cdprep_contacts(model, model, &placement, scratch, 1, NULL, &contact, 1, NULL, NULL) ==
         CDPREP_BAD_ARGUMENT);
    MUST(cdprep_contacts(NULL, model, &placement, scratch, 1, NULL, &contact, 1, &count, NULL) ==
         CDPREP_BAD_ARGUMENT);
    MUST(cdprep_contacts(model, model, &placement, scratch, 1, &no_size, &contact, 1, &count,
                         NULL) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_visit_contacts(model, model, &placement, scratch, 1, NULL, NULL, NULL, NULL) ==
         CDPREP_BAD_ARGUMENT);
    /* A tolerance that none is gives no contacts. */
    MUST(cdprep_contacts(model, model, &placement, scratch, -1, NULL, &contact, 1, &count, NULL) ==
         CDPREP_OK);
    MUST(count == 0);
    MUST(cdprep_piece_count(model) == 1 && cdprep_piece_count(NULL) == 0);
    MUST(cdprep_find_closest_features(&cube, &none, &placement, NULL, &found, &features, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strstr(error.message, "cdprep_piece_count()") != NULL);
    MUST(cdprep_find_closest_features(&of_nothing, &cube, &placement, NULL, &found, &features,
                                      NULL) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_find_closest_features(&cube, &cube, &placement, NULL, NULL, &features, NULL) ==
         CDPREP_BAD_ARGUMENT);
    placement.kind = 9;
    MUST(cdprep_find_closest_features(&cube, &cube, &placement, NULL, &found, &features, NULL) ==
         CDPREP_BAD_ARGUMENT);
    MUST(cdprep_contacts(model, model, &placement, scratch, 1, NULL, &contact, 1, &count, NULL) ==
         CDPREP_BAD_ARGUMENT);
    return NULL;
}

const char* ask_contacts(const void* bytes, size_t size, void* memory, size_t room) {
    cdprep_workspace* scratch = cdprep_make_workspace(memory, room);
    MUST(scratch != NULL);
    cdprep_model* model = NULL;
    MUST(cdprep_open_memory(bytes, size, "cube", &model, NULL) == CDPREP_OK);
    const char* wrong = NULL;
    cdprep_feature_cache cache;
    memset(&cache, 0, sizeof cache);
    for (int i = 6; i <= 12 && wrong == NULL; ++i) {
        wrong = ask_at(model, scratch, i / 8.0);
        if (wrong == NULL) wrong = ask_features(model, i / 8.0, i % 3 == 0 ? NULL : &cache);
    }
    /* Any content of a cache is allowed. */
    memset(&cache, 255, sizeof cache);
    if (wrong == NULL) wrong = ask_features(model, 1.5, &cache);
    if (wrong == NULL) wrong = ask_wrongly(model, scratch);
    cdprep_close(model);
    return wrong;
}
