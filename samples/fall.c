/* SPDX-License-Identifier: MIT */
/* Four crates fall onto a floor, from different heights: when does each of them hit it?
 *
 *     sample_fall */
#include <stdio.h>

#include "cdprep/cdprep.h"

enum { FLOOR, CRATE, CRATES = 4 }; /* two layers, and the number of crates */

static const float corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const float floor_corners[4][3] = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}};
/* Counter-clockwise from outside. */
static const uint32_t crate_triangles[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7},
                                                {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                                {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
static const uint32_t floor_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};

static int build(const float* positions, size_t vertices, const uint32_t* triangles, size_t count,
                 cdprep_workspace* workspace, cdprep_model** model, cdprep_error* error) {
    cdprep_build_options options;
    cdprep_build_options_init(&options, sizeof options);
    options.positions_f32 = positions;
    options.vertex_count = vertices;
    options.triangles = triangles;
    options.triangle_count = count;
    options.ask = CDPREP_ASK_COLLIDE;
    return cdprep_model_build(&options, NULL, 0, workspace, model, error);
}

static int print_refusal(void* context, const char* sentence) {
    (void)context;
    fprintf(stderr, "%s\n", sentence);
    return 1;
}

/* Crates are asked about the floor, and nothing else: they never look at each other. */
static int make_scene(cdprep_scene** scene, cdprep_error* error) {
    cdprep_layer_pair pair;
    cdprep_plan_options options;
    cdprep_plan* plan = NULL;
    int code;
    cdprep_layer_pair_init(&pair, sizeof pair);
    pair.a = FLOOR;
    pair.b = CRATE;
    pair.effects = CDPREP_ASK_COLLIDE;
    cdprep_plan_options_init(&options, sizeof options);
    options.layer_pairs = &pair;
    options.layer_pair_count = 1;
    options.max_objects = 1 + CRATES;
    options.max_pairs = 2 * CRATES;
    if (!(code = cdprep_plan_compile(&options, print_refusal, NULL, &plan, error))) {
        code = cdprep_scene_make(plan, NULL, 0, scene, error);
    }
    cdprep_plan_end(plan); /* the scene keeps what it needs */
    return code;
}

/* Crate i starts i + 0.25 above the floor. */
static int fill(cdprep_scene* scene, const cdprep_model* floor_model, const cdprep_model* crate,
                cdprep_object* ids, cdprep_pose* poses, cdprep_error* error) {
    cdprep_object_options objects[1 + CRATES];
    for (int i = 0; i <= CRATES; ++i) {
        cdprep_object_options_init(&objects[i], sizeof objects[i]);
        objects[i].model = i == 0 ? floor_model : crate;
        objects[i].layer = i == 0 ? FLOOR : CRATE;
    }
    for (int i = 0; i < CRATES; ++i) {
        double* const rows = objects[1 + i].world_from_model.rows;
        rows[9] = 10 + 20 * i; /* x */
        rows[10] = 50;         /* y */
        rows[11] = i + 0.25;   /* z */
        poses[i] = objects[1 + i].world_from_model;
    }
    return cdprep_scene_add(scene, objects, 1 + CRATES, ids, error);
}

static int fall(cdprep_scene* scene, const cdprep_object* crates, cdprep_pose* poses, size_t count,
                cdprep_workspace* workspace, cdprep_error* error) {
    cdprep_step step;
    const cdprep_event* events;
    size_t event_count;
    int code = CDPREP_OK;
    for (int frame = 0; frame < 50; ++frame) {
        for (size_t i = 0; i < count; ++i) poses[i].rows[11] -= 0.125; /* z */
        if ((code = cdprep_scene_set_poses(scene, crates, poses, count, error))) break;
        if ((code = cdprep_scene_step(scene, workspace, &step, error))) break;
        if (step.complete == CDPREP_NO) {
            printf("room for %u pairs is needed\n", (unsigned)step.needed_pairs);
            continue;
        }
        if ((code = cdprep_scene_events(scene, &events, &event_count, error))) break;
        for (size_t i = 0; i < event_count; ++i) {
            printf("frame %d: crate %u %s the floor\n", frame, events[i].b.slot,
                   events[i].kind == CDPREP_EVENT_BEGIN ? "hits" : "has passed");
        }
    }
    return code;
}

int main(void) {
    cdprep_error error;
    cdprep_workspace* workspace = NULL;
    cdprep_model *floor_model = NULL, *crate = NULL;
    cdprep_scene* scene = NULL;
    cdprep_object ids[1 + CRATES];
    cdprep_pose poses[CRATES];
    int code;
    if (!(code = cdprep_workspace_make(NULL, NULL, 0, &workspace, &error)) &&
        !(code =
              build(floor_corners[0], 4, floor_triangles[0], 2, workspace, &floor_model, &error)) &&
        !(code = build(corners[0], 8, crate_triangles[0], 12, workspace, &crate, &error)) &&
        !(code = make_scene(&scene, &error)) &&
        !(code = fill(scene, floor_model, crate, ids, poses, &error))) {
        code = fall(scene, ids + 1, poses, CRATES, workspace, &error);
    }
    if (code) fprintf(stderr, "%s\n", error.message);
    cdprep_scene_end(scene);
    cdprep_model_close(crate);
    cdprep_model_close(floor_model);
    cdprep_workspace_end(workspace);
    return code;
}
