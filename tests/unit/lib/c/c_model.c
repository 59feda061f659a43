/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "c_api.h"
#include "c_asking.h"

/* The mesh and the corners of each triangle are the same points. */
static const char* read_mesh(const cdprep_model* cube) {
    double positions[24];
    uint32_t triangles[36];
    cdprep_mesh mesh = {positions, triangles, NULL, 8, 12, 0, 0};
    MUST(cdprep_model_mesh(cube, &mesh, NULL) == CDPREP_OK);
    MUST(mesh.vertex_count == 8 && mesh.triangle_count == 12);
    for (uint32_t i = 0; i < 12; ++i) {
        cdprep_corners corners;
        MUST(cdprep_model_corners(cube, &i, 1, &corners, NULL) == CDPREP_OK);
        MUST(memcmp(corners.point[0], positions + 3 * triangles[3 * i], sizeof *corners.point) ==
             0);
        MUST(memcmp(corners.point[2], positions + 3 * triangles[3 * i + 2],
                    sizeof *corners.point) == 0);
        MUST(corners.vertex[0] < 8 && corners.degenerate == CDPREP_NO && corners.component == 0);
        MUST(corners.group == CDPREP_NONE && corners.instance == CDPREP_NONE && corners.face == i);
    }
    mesh.vertex_room = mesh.triangle_room = 0;
    mesh.positions = NULL;
    mesh.triangles = NULL;
    MUST(cdprep_model_mesh(cube, &mesh, NULL) == CDPREP_OK);
    MUST(mesh.vertex_count == 8 && mesh.triangle_count == 12);
    return NULL;
}

static int count_triangle(void* count, const double corners[9], uint32_t rgba) {
    size_t* const so_far = (size_t*)count;
    *so_far += corners[0] >= 2 && corners[0] <= 3 && (rgba & 0xff) == 0xff;
    return 1;
}

/* The cube is moved by 2 along x. */
static const char* draw(const cdprep_model* cube) {
    cdprep_draw picture;
    cdprep_world_box around;
    cdprep_pose pose = {{1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 0}}, back;
    size_t count = 0;
    cdprep_error error;
    cdprep_draw_init(&picture, sizeof picture);
    picture.what = CDPREP_DRAW_SURFACE;
    picture.context = &count;
    MUST(cdprep_model_draw(cube, &pose, &picture, &error) == CDPREP_BAD_ARGUMENT);
    MUST(strcmp(error.argument, "draw.triangle") == 0 && error.why == CDPREP_WHY_NULL);
    picture.triangle = count_triangle;
    MUST(cdprep_model_draw(cube, &pose, &picture, NULL) == CDPREP_OK && count == 12);
    MUST(cdprep_model_box(cube, &pose, 0.5, NULL, &around, NULL) == CDPREP_OK);
    MUST(around.lower[0] <= 1.5F && around.lower[0] > 1.499F && around.upper[1] >= 1.5F);
    MUST(cdprep_pose_relative(&pose, &pose, &back, NULL) == CDPREP_OK);
    MUST(back.rows[0] == 1 && back.rows[1] == 0 && back.rows[9] == 0);
    return NULL;
}

const char* read_geometry(const cdprep_model* cube) {
    cdprep_model_info info;
    cdprep_error error;
    MUST(cdprep_model_describe(cube, &info, NULL) == CDPREP_OK);
    MUST(info.triangles == 12 && info.vertices == 8 && info.balanced == CDPREP_YES);
    MUST(info.components == 1 && info.hulls == 0 && info.pieces == 0 && info.stores_f64 == 0);
    MUST((info.serves & CDPREP_ASK_COLLIDE) != 0 && (info.serves & CDPREP_ASK_CONTACTS) == 0);
    for (int i = 0; i < 3; ++i) MUST(info.lower[i] == 0 && info.upper[i] == 1);
    const uint32_t outside = 12;
    cdprep_corners corners;
    MUST(cdprep_model_corners(cube, &outside, 1, &corners, &error) == CDPREP_BAD_ARGUMENT);
    MUST(strcmp(error.argument, "triangles[0]") == 0 && error.why == CDPREP_WHY_OUT_OF_RANGE);
    MUST(cdprep_model_serves(cube, CDPREP_ASK_COLLIDE, &error) == CDPREP_OK);
    MUST(cdprep_model_serves(cube, CDPREP_ASK_CONTACTS, &error) == CDPREP_BAD_ARGUMENT);
    MUST(error.why == CDPREP_WHY_NOT_BAKED && strstr(error.message, "contacts") != NULL);
    MUST(cdprep_model_prefetch(cube, CDPREP_ASK_COLLIDE, &error) == CDPREP_OK);
    cdprep_array array;
    MUST(cdprep_model_section(cube, 3, &array, &error) == CDPREP_OK);
    MUST(array.count == 12 && array.stride == 12 && array.data != NULL);
    MUST(cdprep_model_section(cube, 44, &array, &error) == CDPREP_BAD_ARGUMENT);
    MUST(error.why == CDPREP_WHY_NOT_BAKED && array.data == NULL);
    MUST(cdprep_model_section(cube, 63, &array, &error) == CDPREP_BAD_ARGUMENT);
    MUST(error.why == CDPREP_WHY_OUT_OF_RANGE);
    cdprep_mass mass;
    MUST(cdprep_model_mass(cube, &mass, &error) == CDPREP_BAD_ARGUMENT);
    double bound = 9;
    MUST(cdprep_model_level_error(cube, 3, &bound, &error) == CDPREP_BAD_ARGUMENT && bound == 0);
    MUST(cdprep_model_bytes(cube, &array, NULL) == CDPREP_OK && array.stride == 1);
    MUST(array.count > 1000 && array.data != NULL);
    MUST(strcmp(cdprep_ask_name(CDPREP_ASK_CLOSEST), "closest") == 0);
    const char* const wrong = draw(cube);
    return wrong == NULL ? read_mesh(cube) : wrong;
}
