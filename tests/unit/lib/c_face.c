/* SPDX-License-Identifier: MIT */
#include "c_face.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TEXT(x) #x
#define LINE(x) TEXT(x)
#define MUST(condition)                                                      \
    do {                                                                     \
        if (!(condition)) return "line " LINE(__LINE__) ": not " #condition; \
    } while (0)

static cdprep_placement moved_by(double x) {
    cdprep_placement placement = {sizeof placement,
                                  CDPREP_B_MOVES,
                                  {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}},
                                  {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}}};
    placement.b.rows[9] = x;
    return placement;
}

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

enum { JOBS = 150, ROOM = 100, WORDS = 256 };

/* Every job's answers, with room for them. */
typedef struct answers {
    cdprep_collision collisions[JOBS];
    int found[JOBS];
    cdprep_distance distances[JOBS];
    int within[JOBS];
    cdprep_overlap_answer overlaps[JOBS];
    cdprep_marked_triangles marked[JOBS];
    cdprep_triangle_pair pairs[JOBS][ROOM];
    uint64_t bits[JOBS][2][WORDS];
} answers;

static void give_room(answers* to) {
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_overlap_answer overlap = {to->pairs[i], ROOM, 0};
        const cdprep_marked_triangles marked = {to->bits[i][0], WORDS, to->bits[i][1], WORDS, 0};
        to->overlaps[i] = overlap;
        to->marked[i] = marked;
    }
}

static const cdprep_contact_options proper = {sizeof proper, CDPREP_PROPER, CDPREP_SKIP_DEGENERATE,
                                              CDPREP_SURFACE};
static const cdprep_contact_options solid = {sizeof solid, CDPREP_CLOSED, CDPREP_KEEP_DEGENERATE,
                                             CDPREP_SOLID};
static const cdprep_distance_options near_by = {sizeof near_by, CDPREP_SURFACE, 0, 0, 1};

/* Asks them one by one. */
static const char* ask_alone(const cdprep_pair_job* jobs, cdprep_workspace* scratch, answers* to) {
    give_room(to);
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_pair_job* job = &jobs[i];
        cdprep_overlap_answer* overlap = &to->overlaps[i];
        cdprep_marked_triangles* marked = &to->marked[i];
        MUST(cdprep_collide(job->a, job->b, job->placement, scratch, &solid, NULL,
                            &to->collisions[i], NULL) == CDPREP_OK);
        if (to->collisions[i].containment == CDPREP_YES || !to->collisions[i].hit) {
            cdprep_containment containment;
            MUST(cdprep_find_containment(job->a, job->b, job->placement, scratch, &containment,
                                         NULL) == CDPREP_OK);
            MUST(containment.answer == to->collisions[i].containment);
            MUST(!containment.a_inside_b);
            MUST(containment.winding == (containment.answer == CDPREP_YES ? 1 : 0));
        }
        MUST(cdprep_distance_between(job->a, job->b, job->placement, scratch, &near_by, NULL,
                                     &to->found[i], &to->distances[i], NULL) == CDPREP_OK);
        MUST(cdprep_is_within(job->a, job->b, job->placement, scratch, 0.25, NULL, &to->within[i],
                              NULL) == CDPREP_OK);
        MUST(cdprep_overlapping_triangles(job->a, job->b, job->placement, scratch, &proper, NULL,
                                          overlap->pairs, ROOM, &overlap->count,
                                          NULL) == CDPREP_OK);
        MUST(cdprep_mark_overlapping_triangles(job->a, job->b, job->placement, scratch, NULL, NULL,
                                               marked->bits_a, WORDS, marked->bits_b, WORDS,
                                               &marked->count, NULL) == CDPREP_OK);
    }
    return NULL;
}

/* Asks them all at once. */
static const char* ask_at_once(const cdprep_pair_job* jobs, cdprep_workspaces* scratch,
                               const cdprep_parallel_for* threads, answers* to) {
    cdprep_error error;
    give_room(to);
    MUST(cdprep_collide_all(jobs, JOBS, scratch, threads, &solid, to->collisions, &error) ==
         CDPREP_OK);
    MUST(cdprep_distance_between_all(jobs, JOBS, scratch, threads, &near_by, to->found,
                                     to->distances, &error) == CDPREP_OK);
    MUST(cdprep_is_within_all(jobs, JOBS, scratch, threads, 0.25, to->within, &error) == CDPREP_OK);
    MUST(cdprep_overlapping_triangles_all(jobs, JOBS, scratch, threads, &proper, to->overlaps,
                                          &error) == CDPREP_OK);
    MUST(cdprep_mark_overlapping_triangles_all(jobs, JOBS, scratch, threads, NULL, to->marked,
                                               &error) == CDPREP_OK);
    return NULL;
}

static const char* are_equal(const answers* x, const answers* y) {
    for (int i = 0; i < JOBS; ++i) {
        MUST(x->collisions[i].hit == y->collisions[i].hit);
        MUST(x->collisions[i].containment == y->collisions[i].containment);
        MUST(x->collisions[i].a_inside_b == y->collisions[i].a_inside_b);
        MUST(x->found[i] == y->found[i] && x->within[i] == y->within[i]);
        MUST(x->overlaps[i].count == y->overlaps[i].count);
        MUST(x->marked[i].count == y->marked[i].count);
    }
    MUST(memcmp(x->distances, y->distances, sizeof x->distances) == 0);
    MUST(memcmp(x->pairs, y->pairs, sizeof x->pairs) == 0);
    MUST(memcmp(x->bits, y->bits, sizeof x->bits) == 0);
    return NULL;
}

/* Both answers of every question occur, and pairs that find no room. */
static const char* are_mixed(const answers* x) {
    int hits = 0;
    int contained = 0;
    int found = 0;
    int within = 0;
    int short_of_room = 0;
    for (int i = 0; i < JOBS; ++i) {
        hits += x->collisions[i].hit;
        contained += x->collisions[i].containment == CDPREP_YES;
        found += x->found[i];
        within += x->within[i];
        short_of_room += x->overlaps[i].count > ROOM;
    }
    MUST(hits * 10 > JOBS * 3 && hits * 10 < JOBS * 7);
    MUST(found * 10 > JOBS * 3 && found * 10 < JOBS * 9);
    MUST(within * 10 > JOBS * 3 && within * 10 < JOBS * 7);
    MUST(contained > 0 && short_of_room > 0);
    return NULL;
}

/* A about z, B away from it: from deep inside to far. Of every second one both move. */
static cdprep_placement placed(int i) {
    cdprep_placement placement = moved_by(0.02 * (i - i % 2));
    if (i % 2 == 0) return placement;
    const double angle = 0.1 * i;
    placement.kind = CDPREP_WORLD;
    placement.a.rows[0] = placement.a.rows[4] = cos(angle);
    placement.a.rows[3] = sin(angle);
    placement.a.rows[1] = -placement.a.rows[3];
    return placement;
}

static const char* ask_batches(const cdprep_model* a, const cdprep_model* b,
                               cdprep_workspaces* scratch, const cdprep_parallel_for* threads,
                               const answers* expected, answers* room) {
    cdprep_placement placements[JOBS];
    cdprep_pair_cache caches[JOBS];
    cdprep_pair_job jobs[JOBS];
    memset(caches, 0, sizeof caches);
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_pair_job job = {a, b, &placements[i], i % 3 == 0 ? &caches[i] : NULL};
        placements[i] = placed(i);
        jobs[i] = job;
    }
    for (int again = 0; again < 2; ++again) {
        memset(room, 0, sizeof *room);
        const char* wrong = ask_at_once(jobs, scratch, threads, room);
        if (wrong == NULL) wrong = are_equal(room, expected);
        if (wrong != NULL) return wrong;
    }
    /* One wrong job: its number is told, and nothing is asked. */
    cdprep_error error;
    placements[17].kind = 9;
    room->within[0] = 77;
    MUST(cdprep_is_within_all(jobs, JOBS, scratch, threads, 0.25, room->within, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strstr(error.message, "17") != NULL && room->within[0] == 77);
    jobs[16].b = NULL;
    MUST(cdprep_collide_all(jobs, JOBS, scratch, threads, NULL, room->collisions, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strstr(error.message, "16") != NULL);
    MUST(cdprep_collide_all(NULL, 0, scratch, threads, NULL, NULL, &error) == CDPREP_OK);
    MUST(cdprep_collide_all(jobs, 1, NULL, threads, NULL, room->collisions, &error) ==
         CDPREP_BAD_ARGUMENT);
    const cdprep_parallel_for no_size = {0, NULL, NULL};
    MUST(cdprep_collide_all(jobs, 1, scratch, &no_size, NULL, room->collisions, &error) ==
         CDPREP_BAD_ARGUMENT);
    return NULL;
}

/* A surface on itself: all pairs of triangles that share a corner, or the first. */
static const char* ask_split(const cdprep_model* a, cdprep_workspace* scratch,
                             cdprep_workspaces* many, const cdprep_parallel_for* threads) {
    enum { MOST = 70000 };
    static cdprep_triangle_pair expected[MOST];
    static cdprep_triangle_pair pairs[MOST];
    size_t count = 0;
    size_t counted = 0;
    const cdprep_placement placement = moved_by(0);
    MUST(cdprep_overlapping_triangles(a, a, &placement, scratch, NULL, NULL, expected, MOST, &count,
                                      NULL) == CDPREP_OK);
    MUST(count > 50000 && count <= MOST);
    const size_t rooms[] = {0, 1, count - 1, count, MOST};
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms; ++i) {
        const size_t room = rooms[i];
        memset(pairs, 255, sizeof pairs);
        MUST(cdprep_split_overlapping_triangles(a, a, &placement, many, threads, NULL,
                                                room == 0 ? NULL : pairs, room, &counted,
                                                NULL) == CDPREP_OK);
        MUST(counted == count);
        MUST(memcmp(pairs, expected, sizeof *pairs * (room < count ? room : count)) == 0);
    }
    MUST(cdprep_split_overlapping_triangles(a, a, &placement, many, threads, NULL, NULL, 1,
                                            &counted, NULL) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_split_overlapping_triangles(a, a, &placement, NULL, threads, NULL, NULL, 0,
                                            &counted, NULL) == CDPREP_BAD_ARGUMENT);
    return NULL;
}

/* The scratch of one and of up to eight, in `memory`. */
static const char* ask_on_threads(const cdprep_model* a, const cdprep_model* b, char* memory,
                                  const cdprep_parallel_for* threads, answers room[2]) {
    cdprep_workspace* scratch = cdprep_make_workspace(memory, cdprep_workspace_size());
    MUST(scratch != NULL);
    cdprep_placement placements[JOBS];
    cdprep_pair_job jobs[JOBS];
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_pair_job job = {a, b, &placements[i], NULL};
        placements[i] = placed(i);
        jobs[i] = job;
    }
    const char* wrong = ask_alone(jobs, scratch, &room[0]);
    if (wrong == NULL) wrong = are_mixed(&room[0]);
    const size_t alignment = cdprep_workspace_alignment();
    char* behind = memory + (cdprep_workspace_size() + alignment - 1) / alignment * alignment;
    for (size_t workers = 1; workers <= 8 && wrong == NULL; ++workers) {
        const size_t size = cdprep_workspaces_size(workers);
        MUST(cdprep_make_workspaces(behind, size - 1, workers) == NULL);
        MUST(cdprep_make_workspaces(behind + 1, size, workers) == NULL);
        cdprep_workspaces* many = cdprep_make_workspaces(behind, size, workers);
        MUST(many != NULL);
        wrong = ask_batches(a, b, many, workers == 3 ? NULL : threads, &room[0], &room[1]);
        if (wrong == NULL) wrong = ask_split(a, scratch, many, workers == 3 ? NULL : threads);
    }
    return wrong;
}

const char* ask_many(const void* bytes_a, size_t size_a, const void* bytes_b, size_t size_b,
                     const cdprep_parallel_for* threads) {
    cdprep_model* a = NULL;
    cdprep_model* b = NULL;
    MUST(cdprep_open_memory(bytes_a, size_a, "a", &a, NULL) == CDPREP_OK);
    MUST(cdprep_open_memory(bytes_b, size_b, "b", &b, NULL) == CDPREP_OK);
    MUST(cdprep_make_workspaces(NULL, 1000000, 1) == NULL);
    MUST(cdprep_workspaces_size(SIZE_MAX / 2) == SIZE_MAX);

    const size_t alignment = cdprep_workspace_alignment();
    char* memory = malloc(cdprep_workspace_size() + cdprep_workspaces_size(8) + 2 * alignment);
    char* aligned = memory + (alignment - (uintptr_t)memory % alignment) % alignment;
    MUST(cdprep_make_workspaces(aligned, SIZE_MAX, 0) == NULL);
    answers* room = calloc(2, sizeof *room);
    const char* wrong = ask_on_threads(a, b, aligned, threads, room);
    free(room);
    free(memory);
    cdprep_close(a);
    cdprep_close(b);
    return wrong;
}
