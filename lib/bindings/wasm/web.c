/* SPDX-License-Identifier: MIT */
/* The C API with plain arguments, for cdprep.mjs: structs stay on this side. Numbers go through one
 * array. A function that fails returns less than 0, or null; then web_message() has the sentence.
 * There is one thread, so one workspace and one error serve all calls. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cdprep/cdprep.h"

static cdprep_error error;
static cdprep_workspace* workspace;
static double numbers[32];
static cdprep_overlap* list;
static size_t room;

const char* web_message(void) {
    return error.message;
}
int web_code(void) {
    return error.code;
}
double* web_numbers(void) {
    return numbers;
}
const char* web_version(void) {
    static cdprep_version version;
    cdprep_version_get(&version);
    numbers[0] = version.major, numbers[1] = version.minor, numbers[2] = version.patch;
    return version.kernels;
}

/* Returns memory for the bytes of a file, or null. */
void* web_allocate(size_t size) {
    if (size > SIZE_MAX - CDPREP_ALIGNMENT) return NULL;
    const size_t whole = (size + CDPREP_ALIGNMENT - 1) / CDPREP_ALIGNMENT * CDPREP_ALIGNMENT;
    return aligned_alloc(CDPREP_ALIGNMENT, whole > 0 ? whole : CDPREP_ALIGNMENT);
}
void web_release(void* memory) {
    free(memory);
}

static int no_memory(void) {
    strcpy(error.message, "There is not enough memory.");
    return -CDPREP_OVER_BUDGET;
}

cdprep_model* web_open(const void* bytes, size_t size, const char* name) {
    cdprep_open_options options;
    cdprep_model* model = NULL;
    cdprep_open_options_init(&options, sizeof options);
    options.name = name;
    if (!workspace && cdprep_workspace_make(NULL, NULL, 0, &workspace, &error)) return NULL;
    return cdprep_model_open_memory(bytes, size, &options, &model, &error) ? NULL : model;
}
void web_close(cdprep_model* model) {
    cdprep_model_close(model);
}

/* Stores triangles, vertices, whether balanced, metres_per_unit, and the box. */
int web_describe(const cdprep_model* model) {
    cdprep_model_info info;
    if (cdprep_model_describe(model, &info, &error)) return -error.code;
    numbers[0] = info.triangles, numbers[1] = info.vertices, numbers[2] = info.balanced;
    numbers[3] = info.metres_per_unit;
    for (int i = 0; i < 3; ++i) numbers[4 + i] = info.lower[i], numbers[7 + i] = info.upper[i];
    return 0;
}

/* Fills both arrays, which have room for the whole mesh. */
int web_mesh(const cdprep_model* model, double* positions, size_t vertices, uint32_t* triangles,
             size_t count) {
    cdprep_mesh mesh = {positions, triangles, NULL, vertices, count, 0, 0};
    return -cdprep_model_mesh(model, &mesh, &error);
}

/* Refuses a matrix whose last row is not 0 0 0 1. A pose has no such row. */
static int check_last_row(void) {
    for (int column = 0; column < 4; ++column) {
        const double number = numbers[4 * column + 3], expected = column == 3 ? 1 : 0;
        if (number == expected) continue;
        error.code = CDPREP_BAD_ARGUMENT;
        error.why = CDPREP_WHY_NOT_RIGID;
        strcpy(error.argument, "matrix");
        snprintf(error.message, sizeof error.message,
                 "The matrix projects: its last row must be 0 0 0 1, but number %d of it is %.17g.",
                 column + 1, number);
        return error.code;
    }
    return CDPREP_OK;
}

/* Places B by the matrix in the first 16 numbers, column by column as in WebGL. With the tolerance
 * 0, takes the numbers as they are. */
static int place(const cdprep_model* a, const cdprep_model* b, double tolerance,
                 cdprep_pair* pair) {
    cdprep_pair_init(pair, sizeof *pair);
    pair->a = a;
    pair->b = b;
    if (tolerance != 0) {
        return cdprep_pose_nearest(numbers, CDPREP_COLUMNS, tolerance, &pair->pose_b, &error);
    }
    if (check_last_row()) return error.code;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            pair->pose_b.rows[3 * row + column] = numbers[4 * column + row];
        }
        pair->pose_b.rows[9 + row] = numbers[12 + row];
    }
    return CDPREP_OK; /* the query checks them */
}

/* Returns CDPREP_NO, CDPREP_YES or CDPREP_UNKNOWN. */
int web_collide(const cdprep_model* a, const cdprep_model* b, double tolerance, int solid) {
    cdprep_pair pair;
    cdprep_collision collision;
    if (place(a, b, tolerance, &pair)) return -error.code;
    pair.body = solid ? CDPREP_SOLID : CDPREP_SURFACE;
    if (cdprep_collide(&pair, workspace, &collision, &error)) return -error.code;
    return (int)collision.hit;
}

/* Returns the number of pairs of triangles; web_pairs() has them. */
double web_overlaps(const cdprep_model* a, const cdprep_model* b, double tolerance) {
    cdprep_pair pair;
    if (place(a, b, tolerance, &pair)) return -error.code;
    for (;;) {
        cdprep_overlap_list found = {list, room, 0};
        if (cdprep_overlaps(&pair, workspace, &found, &error)) return -error.code;
        if (found.count <= room) return (double)found.count;
        if (found.count > SIZE_MAX / sizeof *list) return no_memory();
        cdprep_overlap* larger = realloc(list, found.count * sizeof *list);
        if (!larger) return no_memory();
        list = larger;
        room = found.count;
    }
}
const cdprep_overlap* web_pairs(void) {
    return list;
}

static void store_point(const double* point, size_t at) {
    memcpy(numbers + at, point, 3 * sizeof *point);
}

/* Takes the largest distance in number 16. Stores bounds, triangles and nearest points. Returns
 * whether anything is that near. */
int web_distance(const cdprep_model* a, const cdprep_model* b, double tolerance) {
    cdprep_pair pair;
    cdprep_distance_options options;
    cdprep_nearest nearest;
    if (place(a, b, tolerance, &pair)) return -error.code;
    cdprep_distance_options_init(&options, sizeof options);
    options.max_distance = numbers[16];
    if (cdprep_distance(&pair, &options, workspace, &nearest, &error)) return -error.code;
    numbers[0] = nearest.lower, numbers[1] = nearest.upper;
    numbers[2] = nearest.triangle_a, numbers[3] = nearest.triangle_b;
    store_point(nearest.on_a, 4);
    store_point(nearest.on_b, 7);
    return (int)nearest.found;
}

/* Takes an origin, a direction and the largest t. Stores t, the triangle and the point. Returns
 * whether anything is hit. */
int web_ray(const cdprep_model* model) {
    cdprep_ray ray;
    cdprep_ray_query query;
    cdprep_ray_hit hit;
    cdprep_ray_query_init(&query, sizeof query);
    memset(&ray, 0, sizeof ray);
    memcpy(ray.origin, numbers, sizeof ray.origin);
    memcpy(ray.direction, numbers + 3, sizeof ray.direction);
    ray.max_t = numbers[6];
    query.model = model;
    query.rays = &ray;
    query.count = 1;
    if (cdprep_rays_cast(&query, workspace, &hit, &error)) return -error.code;
    numbers[0] = hit.t, numbers[1] = hit.triangle;
    store_point(hit.point, 2);
    return (int)hit.found;
}
