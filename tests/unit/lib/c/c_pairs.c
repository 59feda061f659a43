/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "c_api.h"
#include "c_asking.h"

enum { MOST = 144 }; /* pairs of two cubes' triangles */

static int take_overlap(void* so_far, const cdprep_overlap* overlap) {
    return take(so_far, 100 * overlap->a + overlap->b);
}

static int take_crossing(void* so_far, const cdprep_crossing* crossing) {
    return take(so_far, 100 * crossing->pair.a + crossing->pair.b);
}

static const char* ask_collisions(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_error error;
    cdprep_pair near = moved_by(cube, cube, 0.5);
    cdprep_pair far = moved_by(cube, cube, 3);
    cdprep_collision collision;
    MUST(cdprep_collide(&near, scratch, &collision, &error) == CDPREP_OK);
    MUST(error.code == CDPREP_OK && error.why == 0 && error.message[0] == 0);
    MUST(collision.hit == CDPREP_YES && collision.containment == CDPREP_NO);
    far.body = CDPREP_SOLID;
    MUST(cdprep_collide(&far, scratch, &collision, NULL) == CDPREP_OK);
    MUST(collision.hit == CDPREP_NO && collision.containment == CDPREP_NO);
    far.body = CDPREP_SURFACE;
    MUST(cdprep_containment(&far, scratch, &collision, &error) == CDPREP_OK);
    MUST(collision.hit == CDPREP_NO && collision.containment == CDPREP_NO);
    return NULL;
}

/* The list of a pair is sorted; visitors, marks and crossings say the same. */
static const char* ask_overlaps(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_error error;
    const cdprep_pair near = moved_by(cube, cube, 0.5);
    cdprep_overlap items[MOST];
    cdprep_overlap_list list = {items, MOST, 99};
    cdprep_overlap_list counted = {NULL, 0, 99};
    MUST(cdprep_overlaps(&near, scratch, &list, &error) == CDPREP_OK);
    MUST(list.count > 0 && list.count <= MOST);
    for (size_t i = 1; i < list.count; ++i) {
        MUST(items[i - 1].a < items[i].a ||
             (items[i - 1].a == items[i].a && items[i - 1].b < items[i].b));
    }
    MUST(cdprep_overlaps(&near, scratch, &counted, NULL) == CDPREP_OK);
    MUST(counted.count == list.count);

    size_t sum = 0;
    for (size_t i = 0; i < list.count; ++i) sum += 100 * items[i].a + items[i].b;
    visits all = visit_most(SIZE_MAX), two = visit_most(2);
    MUST(cdprep_overlaps_visit(&near, scratch, take_overlap, &all, &error) == CDPREP_OK);
    MUST(cdprep_overlaps_visit(&near, scratch, take_overlap, &two, NULL) == CDPREP_OK);
    MUST(all.count == list.count && all.triangles == sum && two.count == 2);

    /* Every marked triangle is in a pair. */
    uint64_t bits[1] = {~(uint64_t)0};
    cdprep_marks marks = {bits, NULL, 1, 0, 0};
    MUST(cdprep_overlaps_mark(&near, scratch, &marks, &error) == CDPREP_OK);
    MUST(marks.count == list.count);
    for (uint32_t i = 0; i < 64; ++i) {
        int paired = 0;
        for (size_t k = 0; k < list.count; ++k) paired |= items[k].a == i;
        MUST((int)(bits[0] >> i & 1) == paired);
    }

    /* All placements say the same where nothing turns. */
    for (uint32_t moving = CDPREP_MOVE_B; moving <= CDPREP_MOVE_BOTH; ++moving) {
        for (int moves_a = 0; moves_a < 2; ++moves_a) {
            cdprep_pair same = moved_by(cube, cube, moves_a ? 0.25 : 0.5);
            same.moving = moving;
            if (moves_a) same.pose_a.rows[9] = -0.25;
            MUST(cdprep_overlaps(&same, scratch, &counted, NULL) == CDPREP_OK);
            MUST(counted.count == list.count);
        }
    }
    return NULL;
}

/* No two triangles of a cube without a common vertex touch. */
static const char* ask_itself(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_error error;
    cdprep_overlap_list list = {NULL, 0, 99};
    cdprep_self_query query;
    visits all = visit_most(SIZE_MAX);
    cdprep_self_query_init(&query, sizeof query);
    query.model = cube;
    query.degenerate = CDPREP_SKIP_DEGENERATE;
    MUST(cdprep_self_overlaps(&query, scratch, &list, &error) == CDPREP_OK);
    MUST(list.count == 0);
    MUST(cdprep_self_overlaps_visit(&query, scratch, take_overlap, &all, &error) == CDPREP_OK);
    MUST(all.count == 0);
    return NULL;
}

static const char* ask_crossings(const cdprep_model* cube, cdprep_workspace* scratch) {
    const cdprep_pair near = moved_by(cube, cube, 0.5);
    cdprep_overlap items[MOST];
    cdprep_crossing found[MOST];
    cdprep_overlap_list overlaps = {items, MOST, 0};
    cdprep_crossing_list crossings = {found, MOST, 0};
    MUST(cdprep_overlaps(&near, scratch, &overlaps, NULL) == CDPREP_OK);
    MUST(cdprep_crossings(&near, scratch, &crossings, NULL) == CDPREP_OK);
    MUST(crossings.count == overlaps.count);
    size_t sum = 0, segments = 0;
    for (size_t i = 0; i < crossings.count; ++i) {
        int paired = 0;
        for (size_t k = 0; k < overlaps.count; ++k) {
            paired |= items[k].a == found[i].pair.a && items[k].b == found[i].pair.b;
        }
        MUST(paired);
        sum += 100 * found[i].pair.a + found[i].pair.b;
        segments += found[i].is_flat == CDPREP_NO;
    }
    MUST(segments > 0);
    visits all = visit_most(SIZE_MAX), two = visit_most(2);
    MUST(cdprep_crossings_visit(&near, scratch, take_crossing, &all, NULL) == CDPREP_OK);
    MUST(cdprep_crossings_visit(&near, scratch, take_crossing, &two, NULL) == CDPREP_OK);
    MUST(all.count == crossings.count && all.triangles == sum && two.count == 2);
    crossings.room = 1;
    MUST(cdprep_crossings(&near, scratch, &crossings, NULL) == CDPREP_OK);
    MUST(crossings.count == overlaps.count);
    return NULL;
}

/* The cubes are 2 apart; the cache is carried from question to question. */
static const char* ask_distances(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_error error;
    cdprep_cache cache = {{0}};
    cdprep_pair near = moved_by(cube, cube, 0.5), far = moved_by(cube, cube, 3);
    cdprep_nearest nearest;
    cdprep_collision collision;
    near.cache = far.cache = &cache;
    MUST(cdprep_distance(&far, NULL, scratch, &nearest, &error) == CDPREP_OK);
    MUST(nearest.found == CDPREP_YES && nearest.lower <= 2 && nearest.upper >= 2);
    MUST(nearest.upper - nearest.lower < 1e-12);
    MUST(fabs(nearest.on_b[0] - nearest.on_a[0] - 2) < 1e-12);
    MUST(cdprep_collide(&near, scratch, &collision, NULL) == CDPREP_OK);
    MUST(collision.hit == CDPREP_YES);
    MUST(cdprep_collide(&far, scratch, &collision, NULL) == CDPREP_OK);
    MUST(collision.hit == CDPREP_NO);
    cdprep_overlap_list counted = {NULL, 0, 9};
    MUST(cdprep_overlaps(&far, scratch, &counted, NULL) == CDPREP_OK && counted.count == 0);
    MUST(cdprep_overlaps(&near, scratch, &counted, NULL) == CDPREP_OK && counted.count > 0);
    cdprep_distance_options options;
    cdprep_distance_options_init(&options, sizeof options);
    options.max_distance = 1;
    MUST(cdprep_distance(&far, &options, scratch, &nearest, &error) == CDPREP_OK);
    MUST(nearest.found == CDPREP_NO && nearest.upper == 0);
    uint32_t within = CDPREP_UNKNOWN;
    MUST(cdprep_within(&far, 2, scratch, &within, NULL) == CDPREP_OK && within == CDPREP_YES);
    MUST(cdprep_within(&far, 1.99, scratch, &within, NULL) == CDPREP_OK && within == CDPREP_NO);
    return NULL;
}

/* The faces are 2 apart, and nothing is nearer; at 0 the pairs are those that overlap. */
static const char* ask_within(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_pair near = moved_by(cube, cube, 0.5), far = moved_by(cube, cube, 3);
    cdprep_overlap items[MOST], overlaps[MOST];
    cdprep_overlap_list counted = {NULL, 0, 99}, list = {items, 1, 0}, all = {overlaps, MOST, 0};
    MUST(cdprep_pairs_within(&far, 1.99, scratch, &counted, NULL) == CDPREP_OK);
    MUST(counted.count == 0);
    far.degenerate = CDPREP_SKIP_DEGENERATE;
    MUST(cdprep_pairs_within(&far, 2, scratch, &list, NULL) == CDPREP_OK);
    MUST(list.count > 4 && items[0].a < 12 && items[0].b < 12);
    list.room = MOST;
    MUST(cdprep_overlaps(&near, scratch, &all, NULL) == CDPREP_OK);
    MUST(cdprep_pairs_within(&near, 0, scratch, &list, NULL) == CDPREP_OK);
    MUST(list.count == all.count && memcmp(items, overlaps, all.count * sizeof *items) == 0);
    visits every = visit_most(SIZE_MAX), two = visit_most(2);
    MUST(cdprep_pairs_within_visit(&near, 0, scratch, take_overlap, &every, NULL) == CDPREP_OK);
    MUST(cdprep_pairs_within_visit(&near, 0, scratch, take_overlap, &two, NULL) == CDPREP_OK);
    MUST(every.count == all.count && two.count == 2);
    return NULL;
}

const char* ask_pairs(const cdprep_model* cube, cdprep_workspace* workspace) {
    const char* wrong = ask_collisions(cube, workspace);
    if (wrong == NULL) wrong = ask_overlaps(cube, workspace);
    if (wrong == NULL) wrong = ask_itself(cube, workspace);
    if (wrong == NULL) wrong = ask_crossings(cube, workspace);
    if (wrong == NULL) wrong = ask_distances(cube, workspace);
    if (wrong == NULL) wrong = ask_within(cube, workspace);
    return wrong;
}
