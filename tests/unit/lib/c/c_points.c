/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "c_api.h"
#include "c_asking.h"

static int take_hit(void* so_far, const cdprep_ray_hit* hit) {
    return hit->found == CDPREP_YES ? take(so_far, hit->triangle) : 0;
}

static int take_triangle(void* so_far, uint32_t triangle) {
    return take(so_far, triangle);
}

/* Along x through the cube, from 2 before it: in at 2, out at 3. */
static const char* ask_rays(const cdprep_model* cube, cdprep_workspace* scratch) {
    const cdprep_ray rays[3] = {{{-2, 0.5, 0.25}, {1, 0, 0}, INFINITY},
                                {{-2, 0.5, 0.25}, {-1, 0, 0}, INFINITY},
                                {{-2, 0.5, 0.25}, {1, 0, 0}, 1.5}};
    cdprep_ray_query query;
    cdprep_ray_query_init(&query, sizeof query);
    query.model = cube;
    query.rays = rays;
    query.count = 3;
    cdprep_ray_hit hits[3];
    MUST(cdprep_rays_cast(&query, scratch, hits, NULL) == CDPREP_OK);
    MUST(hits[0].found == CDPREP_YES && hits[0].t == 2 && hits[0].point[0] == 0);
    MUST(hits[0].triangle < 12 && hits[1].found == CDPREP_NO && hits[2].found == CDPREP_NO);
    uint32_t any[3] = {9, 9, 9};
    MUST(cdprep_rays_any(&query, scratch, any, NULL) == CDPREP_OK);
    MUST(any[0] == CDPREP_YES && any[1] == CDPREP_NO && any[2] == CDPREP_NO);
    cdprep_ray_hit all[4];
    cdprep_ray_hit_list lists[3] = {{all, 4, 9}, {NULL, 0, 9}, {NULL, 0, 9}};
    MUST(cdprep_rays_all(&query, scratch, lists, NULL) == CDPREP_OK);
    MUST(lists[0].count == 2 && lists[1].count == 0 && lists[2].count == 0);
    MUST(all[0].t == 2 && all[1].t == 3 && all[1].point[0] == 1 && all[1].found == CDPREP_YES);
    MUST(all[0].triangle == hits[0].triangle && all[1].triangle < 12);
    query.count = 1;
    lists[0].room = 0;
    MUST(cdprep_rays_all(&query, scratch, lists, NULL) == CDPREP_OK && lists[0].count == 2);
    visits every = visit_most(SIZE_MAX), one = visit_most(1);
    MUST(cdprep_rays_visit(&query, scratch, take_hit, &every, NULL) == CDPREP_OK);
    MUST(cdprep_rays_visit(&query, scratch, take_hit, &one, NULL) == CDPREP_OK);
    MUST(every.count == 2 && every.triangles == all[0].triangle + all[1].triangle);
    MUST(one.count == 1);
    return NULL;
}

static const char* ask_places(const cdprep_model* cube, cdprep_workspace* scratch) {
    const double points[9] = {0.5, 0.5, 0.5, -2, 0.5, 0.25, 1, 0.5, 0.25};
    cdprep_point_query query;
    cdprep_point_query_init(&query, sizeof query);
    query.model = cube;
    query.points = points;
    query.count = 3;
    cdprep_point_state states[3];
    MUST(cdprep_points_inside(&query, scratch, states, NULL) == CDPREP_OK);
    MUST(states[0].inside == CDPREP_YES && !states[0].on_surface && states[0].winding == 1);
    MUST(states[1].inside == CDPREP_NO && states[1].winding == 0);
    MUST(states[2].inside == CDPREP_YES && states[2].on_surface == CDPREP_YES);
    cdprep_closest_point closest[3];
    MUST(cdprep_points_closest(&query, scratch, closest, NULL) == CDPREP_OK);
    MUST(closest[0].found == CDPREP_YES && closest[0].lower <= 0.5 && closest[0].upper >= 0.5);
    MUST(closest[1].lower <= 2 && closest[1].upper >= 2 && closest[1].point[0] == 0);
    MUST(closest[2].lower == 0 && closest[2].upper < 1e-12 && closest[2].triangle < 12);
    MUST(closest[2].point[0] > 0.999 && closest[2].point[1] == 0.5 && closest[2].point[2] == 0.25);
    query.max_distance = 1;
    MUST(cdprep_points_closest(&query, scratch, closest, NULL) == CDPREP_OK);
    MUST(closest[0].found == CDPREP_YES && closest[1].found == CDPREP_NO);
    MUST(closest[1].upper == 0 && closest[1].triangle == 0);
    query.count = 0;
    query.points = NULL;
    MUST(cdprep_points_closest(&query, scratch, NULL, NULL) == CDPREP_OK);
    return NULL;
}

/* Of each kind one that is flat at x. */
static cdprep_shape_query shape_at(const cdprep_model* cube, uint32_t shape, double x,
                                   double radius) {
    const double corners[3][3] = {{x, 0, 0}, {x, 1, 1}, {x, 0, 1}};
    cdprep_shape_query query;
    cdprep_shape_query_init(&query, sizeof query);
    query.model = cube;
    query.shape = shape;
    query.radius = radius;
    memcpy(query.a, corners[0], sizeof query.a);
    memcpy(query.b, corners[1], sizeof query.b);
    memcpy(query.c, corners[2], sizeof query.c);
    return query;
}

static const char* ask_touches(const cdprep_model* cube, cdprep_workspace* scratch,
                               uint32_t shape) {
    cdprep_shape_query far = shape_at(cube, shape, 1.25, 0.125);
    const cdprep_shape_query at_face = shape_at(cube, shape, 1, 0);
    uint32_t touches = CDPREP_UNKNOWN;
    MUST(cdprep_touch(&far, scratch, &touches, NULL) == CDPREP_OK && touches == CDPREP_NO);
    MUST(cdprep_touch(&at_face, scratch, &touches, NULL) == CDPREP_OK && touches == CDPREP_YES);
    uint32_t numbers[12];
    cdprep_triangle_list list = {numbers, 12, 0}, counted = {NULL, 0, 0};
    MUST(cdprep_touch_list(&at_face, scratch, &list, NULL) == CDPREP_OK);
    MUST(list.count > 0 && list.count <= 12);
    size_t sum = numbers[0];
    for (size_t i = 1; i < list.count; ++i) {
        MUST(numbers[i - 1] < numbers[i]);
        sum += numbers[i];
    }
    MUST(cdprep_touch_list(&at_face, scratch, &counted, NULL) == CDPREP_OK);
    MUST(counted.count == list.count);
    visits all = visit_most(SIZE_MAX), one = visit_most(1);
    MUST(cdprep_touch_visit(&at_face, scratch, take_triangle, &all, NULL) == CDPREP_OK);
    MUST(cdprep_touch_visit(&at_face, scratch, take_triangle, &one, NULL) == CDPREP_OK);
    MUST(all.count == list.count && all.triangles == sum && one.count == 1);
    far.degenerate = CDPREP_SKIP_DEGENERATE;
    far.world_from_model.rows[9] = 0.25; /* the cube a quarter further */
    MUST(cdprep_touch(&far, scratch, &touches, NULL) == CDPREP_OK && touches == CDPREP_YES);
    return NULL;
}

/* 0.25 from the face, less the radius of what has one. */
static const char* ask_distance(const cdprep_model* cube, cdprep_workspace* scratch,
                                uint32_t shape) {
    cdprep_shape_query far = shape_at(cube, shape, 1.25, 0.125);
    cdprep_nearest nearest;
    cdprep_error error;
    const int code = cdprep_shape_distance(&far, scratch, &nearest, &error);
    const int has_radius = shape == CDPREP_SPHERE || shape == CDPREP_CAPSULE;
    const double exact = has_radius ? 0.125 : 0.25;
    MUST(code == CDPREP_OK && nearest.found == CDPREP_YES);
    MUST(nearest.lower <= exact && exact <= nearest.upper && nearest.triangle_a < 12);
    MUST(nearest.on_a[0] == 1 && nearest.on_b[0] == 1.25 && nearest.triangle_b == CDPREP_NONE);
    far.max_distance = 0.0625;
    MUST(cdprep_shape_distance(&far, scratch, &nearest, NULL) == CDPREP_OK);
    MUST(nearest.found == CDPREP_NO);
    return NULL;
}

/* A shape that touches the cube, and one that does not. */
static const char* ask_two(const cdprep_model* cube, cdprep_workspace* scratch) {
    const cdprep_shape_query two[2] = {shape_at(cube, CDPREP_SPHERE, 1.25, 0.125),
                                       shape_at(cube, CDPREP_SPHERE, 1, 0)};
    uint32_t touches[2] = {CDPREP_UNKNOWN, CDPREP_UNKNOWN};
    cdprep_nearest nearest[2];
    MUST(cdprep_touch_many(two, 2, scratch, touches, NULL) == CDPREP_OK);
    MUST(touches[0] == CDPREP_NO && touches[1] == CDPREP_YES);
    MUST(cdprep_shape_distance_many(two, 2, scratch, nearest, NULL) == CDPREP_OK);
    MUST(nearest[0].found == CDPREP_YES && nearest[0].upper > 0 && nearest[1].upper == 0);
    return NULL;
}

static const char* ask_wide_box(const cdprep_model* cube, cdprep_workspace* scratch) {
    cdprep_shape_query wide = shape_at(cube, CDPREP_BOX, 0, 0);
    for (int i = 0; i < 3; ++i) {
        wide.a[i] = -INFINITY;
        wide.b[i] = INFINITY;
    }
    cdprep_triangle_list all = {NULL, 0, 0};
    MUST(cdprep_touch_list(&wide, scratch, &all, NULL) == CDPREP_OK && all.count == 12);
    return NULL;
}

const char* ask_points(const cdprep_model* cube, cdprep_workspace* workspace) {
    const char* wrong = ask_rays(cube, workspace);
    if (wrong == NULL) wrong = ask_places(cube, workspace);
    for (uint32_t shape = CDPREP_BOX; shape <= CDPREP_TRIANGLE; ++shape) {
        if (wrong == NULL) wrong = ask_touches(cube, workspace, shape);
        if (wrong == NULL) wrong = ask_distance(cube, workspace, shape);
    }
    if (wrong == NULL) wrong = ask_two(cube, workspace);
    if (wrong == NULL) wrong = ask_wide_box(cube, workspace);
    return wrong;
}
