/* SPDX-License-Identifier: MIT */
/* A mesh from arrays, without a file: does it hit itself when it is moved, and how far is it?
 *
 *     sample_build */
#include <stdio.h>

#include "cdprep/cdprep.h"

static const float positions[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
/* Counter-clockwise from outside. Triangles share the corners that they have in common. */
static const uint32_t triangles[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7},
                                          {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                          {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};

static int build_cube(cdprep_workspace* workspace, cdprep_model** cube, cdprep_error* error) {
    cdprep_build_options options;
    cdprep_build_options_init(&options, sizeof options);
    options.positions_f32 = positions[0];
    options.vertex_count = 8;
    options.triangles = triangles[0];
    options.triangle_count = 12;
    options.ask = CDPREP_ASK_COLLIDE | CDPREP_ASK_DISTANCE;
    /* Or with memory of yours, cdprep_model_build_size() bytes of it. */
    return cdprep_model_build(&options, NULL, 0, workspace, cube, error);
}

static int print_steps(const cdprep_model* cube, cdprep_workspace* workspace, cdprep_error* error) {
    cdprep_pair pair;
    cdprep_collision found;
    cdprep_nearest nearest;
    int code = CDPREP_OK;
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = cube;
    pair.b = cube;
    for (int i = 0; i < 7; ++i) {
        pair.pose_b.rows[9] = 0.25 * i; /* x */
        if ((code = cdprep_collide(&pair, workspace, &found, error))) break;
        printf("x = %g: ", 0.25 * i);
        if (found.hit == CDPREP_YES) {
            puts("hit");
            continue;
        }
        if ((code = cdprep_distance(&pair, NULL, workspace, &nearest, error))) break;
        printf("%g apart\n", nearest.upper);
    }
    return code;
}

int main(void) {
    cdprep_error error;
    cdprep_workspace* workspace = NULL;
    cdprep_model* cube = NULL;
    cdprep_model_info info;
    int code;
    if (!(code = cdprep_workspace_make(NULL, NULL, 0, &workspace, &error)) &&
        !(code = build_cube(workspace, &cube, &error)) &&
        !(code = cdprep_model_describe(cube, &info, &error))) {
        printf("%u triangles, %s\n", info.triangles,
               info.balanced == CDPREP_YES ? "balanced" : "unbalanced");
        code = print_steps(cube, workspace, &error);
    }
    if (code) fprintf(stderr, "%s\n", error.message);
    cdprep_model_close(cube);
    cdprep_workspace_end(workspace);
    return code;
}
