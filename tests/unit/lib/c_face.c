/* SPDX-License-Identifier: MIT */
#include "c_face.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "c_asking.h"

/* Of answers that were visited: how many, and how many more are wanted. */
typedef struct visits {
    size_t count;
    size_t left;
    size_t triangles; /* the sum of their numbers */
} visits;

static int take(visits* so_far, size_t triangles) {
    ++so_far->count;
    so_far->triangles += triangles;
    return so_far->left-- > 1;
}

static int take_pair(void* so_far, const cdprep_triangle_pair* pair) {
    return take(so_far, 100 * pair->a + pair->b);
}

static int take_crossing(void* so_far, const cdprep_crossing* crossing) {
    return take(so_far, 100 * crossing->pair.a + crossing->pair.b);
}

static int take_hit(void* so_far, const cdprep_ray_hit* hit) {
    return take(so_far, hit->triangle);
}

static int take_triangle(void* so_far, uint32_t triangle) {
    return take(so_far, triangle);
}

static const char* ask_two(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_error error;
    cdprep_placement near = moved_by(0.5);
    cdprep_placement far = moved_by(3);
    cdprep_contact_options solid = {sizeof solid, CDPREP_CLOSED, CDPREP_KEEP_DEGENERATE,
                                    CDPREP_SOLID};
    cdprep_collision collision;
    MUST(cdprep_collide(cube, cube, &near, scratch, NULL, NULL, &collision, &error) == CDPREP_OK);
    MUST(collision.hit == 1);
    MUST(cdprep_collide(cube, cube, &far, scratch, &solid, NULL, &collision, NULL) == CDPREP_OK);
    MUST(collision.hit == 0 && collision.containment == CDPREP_NO);

    cdprep_containment containment = {CDPREP_YES, 1, 1};
    MUST(cdprep_find_containment(cube, cube, &far, scratch, &containment, &error) == CDPREP_OK);
    MUST(containment.answer == CDPREP_NO);

    cdprep_triangle_pair pairs[144];
    size_t count = 0;
    size_t counted = 0;
    MUST(cdprep_overlapping_triangles(cube, cube, &near, scratch, NULL, NULL, pairs, 144, &count,
                                      &error) == CDPREP_OK);
    MUST(count > 0 && count <= 144);
    for (size_t i = 1; i < count; ++i) {
        MUST(pairs[i - 1].a < pairs[i].a ||
             (pairs[i - 1].a == pairs[i].a && pairs[i - 1].b < pairs[i].b));
    }
    MUST(cdprep_overlapping_triangles(cube, cube, &near, scratch, NULL, NULL, NULL, 0, &counted,
                                      NULL) == CDPREP_OK);
    MUST(counted == count);

    /* Visitors see the same pairs, and end the search. */
    size_t sum = 0;
    for (size_t i = 0; i < count; ++i) sum += 100 * pairs[i].a + pairs[i].b;
    visits all = {0, SIZE_MAX, 0};
    visits all_crossings = {0, SIZE_MAX, 0};
    visits two = {0, 2, 0};
    visits two_crossings = {0, 2, 0};
    MUST(cdprep_visit_overlapping_triangles(cube, cube, &near, scratch, NULL, NULL, take_pair, &all,
                                            &error) == CDPREP_OK);
    MUST(cdprep_visit_overlapping_triangles(cube, cube, &near, scratch, NULL, NULL, take_pair, &two,
                                            NULL) == CDPREP_OK);
    MUST(cdprep_visit_crossing_segments(cube, cube, &near, scratch, NULL, take_crossing,
                                        &all_crossings, &error) == CDPREP_OK);
    MUST(cdprep_visit_crossing_segments(cube, cube, &near, scratch, NULL, take_crossing,
                                        &two_crossings, NULL) == CDPREP_OK);
    MUST(all.count == count && all.triangles == sum && two.count == 2);
    MUST(all_crossings.count == count && all_crossings.triangles == sum);
    MUST(two_crossings.count == 2);

    /* Every marked triangle stands in a pair, and every crossing is one of the pairs. */
    uint64_t bits_a[1] = {~(uint64_t)0};
    MUST(cdprep_mark_overlapping_triangles(cube, cube, &near, scratch, NULL, NULL, bits_a, 1, NULL,
                                           0, &counted, &error) == CDPREP_OK);
    MUST(counted == count);
    for (uint32_t i = 0; i < 64; ++i) {
        int paired = 0;
        for (size_t k = 0; k < count; ++k) paired |= pairs[k].a == i;
        MUST((int)(bits_a[0] >> i & 1) == paired);
    }
    cdprep_crossing crossings[144];
    MUST(cdprep_crossing_segments(cube, cube, &near, scratch, NULL, crossings, 144, &counted,
                                  &error) == CDPREP_OK);
    MUST(counted == count);
    int segments = 0;
    for (size_t i = 0; i < count; ++i) {
        int paired = 0;
        for (size_t k = 0; k < count; ++k) {
            paired |= pairs[k].a == crossings[i].pair.a && pairs[k].b == crossings[i].pair.b;
        }
        MUST(paired);
        segments += crossings[i].is_flat == 0;
    }
    MUST(segments > 0);

    cdprep_pair_cache cache = {{0}};
    cdprep_distance distance;
    int found = 0;
    MUST(cdprep_distance_between(cube, cube, &far, scratch, NULL, &cache, &found, &distance,
                                 &error) == CDPREP_OK);
    MUST(found == 1 && distance.lower <= 2 && distance.upper >= 2);
    MUST(distance.upper - distance.lower < 1e-12);
    MUST(fabs(distance.witness_b[0] - distance.witness_a[0] - 2) < 1e-12);
    MUST(cdprep_collide(cube, cube, &near, scratch, NULL, &cache, &collision, NULL) == CDPREP_OK);
    MUST(collision.hit == 1);
    MUST(cdprep_collide(cube, cube, &far, scratch, NULL, &cache, &collision, NULL) == CDPREP_OK);
    MUST(collision.hit == 0);
    MUST(cdprep_overlapping_triangles(cube, cube, &far, scratch, NULL, &cache, NULL, 0, &counted,
                                      NULL) == CDPREP_OK);
    MUST(counted == 0);
    MUST(cdprep_overlapping_triangles(cube, cube, &near, scratch, NULL, &cache, NULL, 0, &counted,
                                      NULL) == CDPREP_OK);
    MUST(counted == count);
    cdprep_distance_options nearby = {sizeof nearby, CDPREP_SURFACE, 0, 0, 1};
    MUST(cdprep_distance_between(cube, cube, &far, scratch, &nearby, &cache, &found, &distance,
                                 &error) == CDPREP_OK);
    MUST(found == 0);
    int within = 0;
    MUST(cdprep_is_within(cube, cube, &far, scratch, 2, NULL, &within, NULL) == CDPREP_OK);
    MUST(within == 1);
    MUST(cdprep_is_within(cube, cube, &far, scratch, 1.99, &cache, &within, NULL) == CDPREP_OK);
    MUST(within == 0);

    /* The faces are 2 apart, and nothing is nearer; at 0 the pairs are those that overlap. */
    cdprep_triangle_pair near_pairs[144];
    MUST(cdprep_triangles_within(cube, cube, &far, scratch, 1.99, NULL, NULL, 0, &counted,
                                 &error) == CDPREP_OK);
    MUST(counted == 0);
    MUST(cdprep_triangles_within(cube, cube, &far, scratch, 2, &solid, near_pairs, 1, &counted,
                                 NULL) == CDPREP_OK);
    MUST(counted > 4 && near_pairs[0].a < 12 && near_pairs[0].b < 12);
    MUST(cdprep_triangles_within(cube, cube, &near, scratch, 0, NULL, near_pairs, 144, &counted,
                                 NULL) == CDPREP_OK);
    MUST(counted == count && memcmp(near_pairs, pairs, count * sizeof pairs[0]) == 0);
    MUST(cdprep_triangles_within(cube, cube, &near, scratch, 0, NULL, NULL, 1, &counted, &error) ==
         CDPREP_BAD_ARGUMENT);

    /* All four kinds of placement say the same where nothing turns. */
    for (uint32_t kind = CDPREP_B_MOVES; kind <= CDPREP_WORLD; ++kind) {
        cdprep_placement same = moved_by(0.5);
        same.kind = kind;
        if (kind == CDPREP_A_MOVES) same.a.rows[9] = -0.5;
        MUST(cdprep_overlapping_triangles(cube, cube, &same, scratch, NULL, NULL, NULL, 0, &counted,
                                          NULL) == CDPREP_OK);
        MUST(counted == count);
    }
    return NULL;
}

static const char* ask_one(const cdprep_model* cube, cdprep_workspace* scratch) {
    const double middle[3] = {0.5, 0.5, 0.5};
    const double beside[3] = {-2, 0.5, 0.25};
    const double along_x[3] = {1, 0, 0};
    const double away[3] = {-1, 0, 0};
    int found = 0;
    cdprep_ray_hit hit;
    MUST(cdprep_cast_ray(cube, beside, along_x, HUGE_VAL, scratch, &found, &hit, NULL) ==
         CDPREP_OK);
    MUST(found == 1 && hit.t == 2 && hit.point[0] == 0 && hit.triangle < 12);
    MUST(cdprep_cast_ray(cube, beside, away, HUGE_VAL, scratch, &found, &hit, NULL) == CDPREP_OK);
    MUST(found == 0);
    int any = 0;
    size_t count = 0;
    cdprep_ray_hit hits[4];
    MUST(cdprep_ray_hits(cube, beside, along_x, HUGE_VAL, scratch, &any, NULL) == CDPREP_OK);
    MUST(any == 1);
    MUST(cdprep_ray_hits(cube, beside, along_x, 1.5, scratch, &any, NULL) == CDPREP_OK);
    MUST(any == 0);
    MUST(cdprep_all_ray_hits(cube, beside, along_x, HUGE_VAL, scratch, hits, 4, &count, NULL) ==
         CDPREP_OK);
    MUST(count == 2 && hits[0].t == 2 && hits[1].t == 3 && hits[1].point[0] == 1);
    MUST(hits[0].triangle < 12 && hits[0].triangle != hits[1].triangle);
    MUST(cdprep_all_ray_hits(cube, beside, along_x, HUGE_VAL, scratch, NULL, 0, &count, NULL) ==
         CDPREP_OK);
    MUST(count == 2);
    visits all = {0, SIZE_MAX, 0};
    visits one = {0, 1, 0};
    MUST(cdprep_visit_ray_hits(cube, beside, along_x, HUGE_VAL, scratch, take_hit, &all, NULL) ==
         CDPREP_OK);
    MUST(cdprep_visit_ray_hits(cube, beside, along_x, HUGE_VAL, scratch, take_hit, &one, NULL) ==
         CDPREP_OK);
    MUST(all.count == 2 && all.triangles == hits[0].triangle + hits[1].triangle && one.count == 1);
    cdprep_closest_point closest;
    MUST(cdprep_find_closest_point(cube, beside, HUGE_VAL, scratch, &found, &closest, NULL) ==
         CDPREP_OK);
    MUST(found == 1 && closest.lower <= 2 && closest.upper >= 2 && closest.point[0] == 0);
    MUST(cdprep_find_closest_point(cube, beside, 1, scratch, &found, &closest, NULL) == CDPREP_OK);
    MUST(found == 0);
    cdprep_inclusion inclusion;
    MUST(cdprep_includes(cube, middle, scratch, &inclusion, NULL) == CDPREP_OK);
    MUST(inclusion.inside == CDPREP_YES && !inclusion.on_surface && inclusion.winding == 1);
    MUST(cdprep_includes(cube, beside, scratch, &inclusion, NULL) == CDPREP_OK);
    MUST(inclusion.inside == CDPREP_NO);
    return NULL;
}

static cdprep_shape shape_of(uint32_t kind, double x, double radius) {
    cdprep_shape shape = {sizeof shape, kind, {0, 0, 0}, {0, 1, 1}, {0, 0, 1}, 0};
    shape.a[0] = x;
    shape.b[0] = x;
    shape.c[0] = x;
    shape.radius = radius;
    return shape;
}

/* Each kind, flat at x: the faces at 0 and 1 and a place between or beyond. */
static const char* ask_shapes(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_error error;
    uint32_t numbers[12];
    size_t count = 0;
    int touches = 0;
    for (uint32_t kind = CDPREP_BOX; kind <= CDPREP_TRIANGLE; ++kind) {
        cdprep_shape far = shape_of(kind, 1.25, 0.125);
        cdprep_shape at_face = shape_of(kind, 1, 0);
        MUST(cdprep_touches(cube, &far, scratch, NULL, &touches, &error) == CDPREP_OK);
        MUST(touches == 0);
        MUST(cdprep_touches(cube, &at_face, scratch, NULL, &touches, NULL) == CDPREP_OK);
        MUST(touches == 1);
        MUST(cdprep_touching_triangles(cube, &at_face, scratch, NULL, numbers, 12, &count,
                                       &error) == CDPREP_OK);
        MUST(count > 0 && count <= 12);
        for (size_t i = 1; i < count; ++i) MUST(numbers[i - 1] < numbers[i]);
        size_t sum = 0;
        for (size_t i = 0; i < count; ++i) sum += numbers[i];
        visits all = {0, SIZE_MAX, 0};
        visits one = {0, 1, 0};
        MUST(cdprep_visit_touching_triangles(cube, &at_face, scratch, NULL, take_triangle, &all,
                                             &error) == CDPREP_OK);
        MUST(cdprep_visit_touching_triangles(cube, &at_face, scratch, NULL, take_triangle, &one,
                                             NULL) == CDPREP_OK);
        MUST(all.count == count && all.triangles == sum && one.count == 1);
        size_t counted = 0;
        MUST(cdprep_touching_triangles(cube, &at_face, scratch, NULL, NULL, 0, &counted, NULL) ==
             CDPREP_OK);
        MUST(counted == count);
        /* The cube a quarter further. */
        cdprep_shape_options moved = {sizeof moved,
                                      CDPREP_SKIP_DEGENERATE,
                                      1,
                                      {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0.25, 0, 0}},
                                      HUGE_VAL};
        MUST(cdprep_touches(cube, &far, scratch, &moved, &touches, NULL) == CDPREP_OK);
        MUST(touches == 1);
        cdprep_shape_distance distance;
        int found = 0;
        const int code = cdprep_distance_to(cube, &far, scratch, NULL, &found, &distance, &error);
        if (kind < CDPREP_CAPSULE) {
            MUST(code == CDPREP_BAD_ARGUMENT);
            continue;
        }
        const double exact = kind == CDPREP_CAPSULE ? 0.125 : 0.25;
        MUST(code == CDPREP_OK && found == 1);
        MUST(distance.lower <= exact && exact <= distance.upper);
        MUST(distance.on_model[0] == 1 && distance.on_shape[0] == 1.25);
        cdprep_shape_options nearby = {sizeof nearby, CDPREP_KEEP_DEGENERATE, 0, {{0}}, 0.0625};
        MUST(cdprep_distance_to(cube, &far, scratch, &nearby, &found, &distance, NULL) ==
             CDPREP_OK);
        MUST(found == 0);
    }
    cdprep_shape wrong = shape_of(4, 0, 0);
    MUST(cdprep_touches(cube, &wrong, scratch, NULL, &touches, &error) == CDPREP_BAD_ARGUMENT);
    wrong = shape_of(CDPREP_BOX, 0, 0);
    wrong.size = 8;
    MUST(cdprep_touches(cube, &wrong, scratch, NULL, &touches, &error) == CDPREP_BAD_ARGUMENT);
    wrong = shape_of(CDPREP_BOX, 0, 0);
    MUST(cdprep_touching_triangles(cube, &wrong, scratch, NULL, NULL, 1, &count, &error) ==
         CDPREP_BAD_ARGUMENT);
    return NULL;
}

static const char* ask_wrongly(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_error error;
    cdprep_collision collision;
    cdprep_placement placement = moved_by(0);
    MUST(cdprep_collide(NULL, cube, &placement, scratch, NULL, NULL, &collision, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(error.code == CDPREP_BAD_ARGUMENT && strlen(error.message) > 10);
    MUST(cdprep_collide(cube, cube, &placement, NULL, NULL, NULL, &collision, NULL) ==
         CDPREP_BAD_ARGUMENT);
    placement.size = 0;
    MUST(cdprep_collide(cube, cube, &placement, scratch, NULL, NULL, &collision, &error) ==
         CDPREP_BAD_ARGUMENT);
    placement = moved_by(0);
    placement.kind = 4;
    MUST(cdprep_collide(cube, cube, &placement, scratch, NULL, NULL, &collision, &error) ==
         CDPREP_BAD_ARGUMENT);
    placement = moved_by(0);
    placement.b.rows[0] = 2;
    MUST(cdprep_collide(cube, cube, &placement, scratch, NULL, NULL, &collision, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strstr(error.message, "turn") != NULL);
    placement = moved_by(0);
    MUST(cdprep_visit_overlapping_triangles(cube, cube, &placement, scratch, NULL, NULL, NULL, NULL,
                                            &error) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_find_containment(cube, cube, &placement, scratch, NULL, &error) ==
         CDPREP_BAD_ARGUMENT);
    cdprep_model* none = NULL;
    MUST(cdprep_open("no such file", &none, &error) == CDPREP_UNREADABLE);
    MUST(none == NULL && strstr(error.message, "no such file") != NULL);
    MUST(cdprep_open_memory("short", 5, "bytes", &none, &error) != CDPREP_OK && none == NULL);
    MUST(cdprep_triangle_count(NULL) == 0 && !cdprep_is_closed(NULL));
    cdprep_verdict verdict;
    MUST(cdprep_verdict_count(NULL) == 0 && cdprep_repaired_from(NULL) == NULL);
    MUST(cdprep_verdict_count(cube) == 0 && !cdprep_read_verdict(cube, 0, &verdict));
    cdprep_close(NULL);
    return NULL;
}

static const char* ask_with(const cdprep_model* cube, cdprep_workspace* scratch) {
    const char* wrong = ask_two(cube, scratch);
    if (wrong == NULL) wrong = ask_one(cube, scratch);
    if (wrong == NULL) wrong = ask_shapes(cube, scratch);
    if (wrong == NULL) wrong = ask_wrongly(cube, scratch);
    return wrong;
}

const char* ask_everything(const void* bytes, size_t size, const char* path) {
    cdprep_error error;
    cdprep_model* cube = NULL;
    MUST(cdprep_open_memory(bytes, size, "cube", &cube, &error) == CDPREP_OK);
    MUST(cdprep_triangle_count(cube) == 12 && cdprep_vertex_count(cube) == 8);
    MUST(cdprep_is_closed(cube));

    const size_t alignment = cdprep_workspace_alignment();
    char* memory = malloc(cdprep_workspace_size() + alignment);
    char* aligned = memory + (alignment - (uintptr_t)memory % alignment) % alignment;
    MUST(cdprep_make_workspace(NULL, 1000000) == NULL);
    MUST(cdprep_make_workspace(aligned, cdprep_workspace_size() - 1) == NULL);
    cdprep_workspace* scratch = cdprep_make_workspace(aligned, cdprep_workspace_size());
    MUST(scratch != NULL);

    const char* wrong = ask_with(cube, scratch);
    cdprep_close(cube);
    cdprep_model* again = NULL;
    if (wrong == NULL && cdprep_open(path, &again, &error) != CDPREP_OK) wrong = "cdprep_open";
    if (wrong == NULL) wrong = ask_with(again, scratch);
    cdprep_close(again);
    if (wrong == NULL && cdprep_open_trusted(path, &again, &error) != CDPREP_OK) {
        wrong = "cdprep_open_trusted";
    }
    if (wrong == NULL) wrong = ask_with(again, scratch);
    cdprep_close(again);
    free(memory);
    return wrong;
}
