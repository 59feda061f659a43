/* SPDX-License-Identifier: MIT */
/* The collisions of a game: two bodies fall into a level. All memory comes from one arena, which
 * is closed after loading.
 *
 *     cdprep bake tray.obj crate.obj jack.obj --effects contacts,overlap,corners
 *     sample_game tray.cdp.h5 crate.cdp.h5 jack.cdp.h5 */
#include <stdint.h>
#include <stdio.h>

#include "cdprep/cdprep.h"

enum { OBJECTS = 3, FRAMES = 120, MAX_LINES = 6000 };

static unsigned char arena[32 << 20];
static size_t arena_used;

static void* take(void* context, size_t size, size_t alignment) {
    const size_t over = (uintptr_t)(arena + arena_used) % alignment;
    const size_t begin = arena_used + (over ? alignment - over : 0);
    (void)context;
    if (begin > sizeof arena || size > sizeof arena - begin) return NULL;
    arena_used = begin + size;
    return arena + begin;
}

/* The arena is released as a whole. */
static void keep(void* context, void* memory, size_t size) {
    (void)context, (void)memory, (void)size;
}

static const cdprep_allocator allocator = {take, keep, NULL};

/* By slot in the scene; the first is the level. */
static cdprep_model* models[OBJECTS];
static cdprep_object ids[OBJECTS];
static cdprep_pose poses[OBJECTS], last_poses[OBJECTS];

static float lines[MAX_LINES][2][3]; /* for the renderer */
static unsigned line_count, contact_count;

/* Reads a file into the rest of the arena, and opens the model there. */
static int load(const char* path, cdprep_model** model, cdprep_error* error) {
    cdprep_open_options options;
    void* const bytes = take(NULL, 0, CDPREP_ALIGNMENT);
    FILE* const file = fopen(path, "rb");
    const size_t size = file && bytes ? fread(bytes, 1, sizeof arena - arena_used, file) : 0;
    const int is_whole = file && feof(file);
    if (file) fclose(file);
    if (!is_whole) {
        snprintf(error->message, sizeof error->message, "%s cannot be read into the arena.", path);
        return CDPREP_UNREADABLE;
    }
    arena_used += size;
    cdprep_open_options_init(&options, sizeof options);
    options.ask = CDPREP_ASK_CONTACTS | CDPREP_ASK_OVERLAP | CDPREP_ASK_CORNERS;
    options.name = path;
    options.allocator = &allocator;
    return cdprep_model_open_memory(bytes, size, &options, model, error);
}

/* All objects are in one layer: each is asked about each other one. */
static int make_scene(cdprep_scene** scene, cdprep_error* error) {
    cdprep_layer_pair pair;
    cdprep_plan_options options;
    cdprep_plan* plan = NULL;
    int code;
    cdprep_layer_pair_init(&pair, sizeof pair);
    pair.effects = CDPREP_ASK_CONTACTS | CDPREP_ASK_OVERLAP;
    cdprep_plan_options_init(&options, sizeof options);
    options.layer_pairs = &pair;
    options.layer_pair_count = 1;
    options.max_objects = OBJECTS;
    options.max_pairs = 2 * OBJECTS;
    options.max_triangle_pairs = MAX_LINES / 6;
    options.max_contacts = 16 * OBJECTS; /* 16 of each pair, the default */
    options.allocator = &allocator;
    if (!(code = cdprep_plan_compile(&options, NULL, NULL, &plan, error))) {
        code = cdprep_scene_make(plan, NULL, 0, scene, error);
    }
    cdprep_plan_end(plan);
    return code;
}

static int fill(cdprep_scene* scene, cdprep_error* error) {
    cdprep_object_options options[OBJECTS];
    for (int i = 0; i < OBJECTS; ++i) {
        cdprep_object_options_init(&options[i], sizeof options[i]);
        options[i].model = models[i];
        if (i > 0) options[i].world_from_model.rows[9] = 0.3 * i - 0.4; /* x */
        if (i > 0) options[i].world_from_model.rows[11] = 1.2 * i;      /* z */
        poses[i] = last_poses[i] = options[i].world_from_model;
    }
    return cdprep_scene_add(scene, options, OBJECTS, ids, error);
}

/* Moves both out along the normal of their deepest contact, and stops them. The level stands. */
static void respond(const cdprep_scene_contact* pair) {
    const double share = pair->a.slot == 0 ? 1 : 0.5; /* of B */
    size_t i = 0;
    contact_count += (unsigned)pair->count;
    while (i < pair->count && pair->items[i].flags & CDPREP_CONTACT_FROM_BEHIND) ++i;
    if (i == pair->count) return;
    for (int k = 0; k < 3; ++k) {
        const double way = -pair->items[i].lower * pair->items[i].normal[k];
        poses[pair->a.slot].rows[9 + k] -= (1 - share) * way;
        poses[pair->b.slot].rows[9 + k] += share * way;
    }
    last_poses[pair->a.slot] = poses[pair->a.slot];
    last_poses[pair->b.slot] = poses[pair->b.slot];
}

/* Adds the edges of a triangle to the lines. Ends the picture when they are full. */
static int draw_edges(void* context, const double corners[9], uint32_t rgba) {
    (void)context, (void)rgba;
    for (int edge = 0; edge < 3 && line_count < MAX_LINES; ++edge, ++line_count) {
        for (int axis = 0; axis < 3; ++axis) {
            lines[line_count][0][axis] = (float)corners[3 * edge + axis];
            lines[line_count][1][axis] = (float)corners[3 * (edge + 1) % 9 + axis];
        }
    }
    return line_count < MAX_LINES;
}

/* Moves a body on as it moved in the last frame, and lets it fall. */
static void move(int body) {
    const double frame_s = 1.0 / 60, gravity = -9.81;
    const cdprep_pose now = poses[body];
    for (int k = 9; k < 12; ++k) poses[body].rows[k] += now.rows[k] - last_poses[body].rows[k];
    poses[body].rows[11] += gravity * frame_s * frame_s;
    last_poses[body] = now;
}

static int step(cdprep_scene* scene, cdprep_workspace* workspace, cdprep_error* error) {
    const cdprep_scene_contact* contacts;
    size_t pairs;
    cdprep_draw picture;
    cdprep_step done;
    int code;
    for (int i = 1; i < OBJECTS; ++i) move(i);
    code = cdprep_scene_set_poses(scene, ids + 1, poses + 1, OBJECTS - 1, error);
    if (code || (code = cdprep_scene_step(scene, workspace, &done, error))) return code;
    line_count = contact_count = 0;
    if (done.complete == CDPREP_NO) return puts("The scene needs more room."), CDPREP_OK;
    cdprep_draw_init(&picture, sizeof picture);
    picture.what = CDPREP_DRAW_OVERLAPS; /* the triangles that touch */
    picture.triangle = draw_edges;
    if ((code = cdprep_scene_draw(scene, &picture, error))) return code;
    if ((code = cdprep_scene_contacts(scene, &contacts, &pairs, error))) return code;
    for (size_t i = 0; i < pairs; ++i) respond(&contacts[i]);
    return CDPREP_OK;
}

int main(int argc, char** argv) {
    cdprep_error error = {0};
    cdprep_workspace_options options;
    cdprep_workspace* workspace = NULL;
    cdprep_scene* scene = NULL;
    int code = CDPREP_OK;
    if (argc != 1 + OBJECTS) return fputs("usage: sample_game LEVEL BODY BODY\n", stderr), 2;
    cdprep_workspace_options_init(&options, sizeof options);
    options.allocator = &allocator;
    for (int i = 0; i < OBJECTS && !code; ++i) code = load(argv[1 + i], &models[i], &error);
    if (!code && !(code = cdprep_workspace_make(&options, NULL, 0, &workspace, &error)) &&
        !(code = make_scene(&scene, &error)) && !(code = fill(scene, &error))) {
        printf("%u KiB in use\n", (unsigned)(arena_used >> 10));
        arena_used = sizeof arena; /* closed: nothing more can be taken */
        for (int frame = 0; frame < FRAMES && !code; ++frame) {
            code = step(scene, workspace, &error);
            if (frame % 20 != 19) continue;
            printf("frame %d: %u contacts, %u lines, heights %.3f %.3f\n", frame, contact_count,
                   line_count, poses[1].rows[11], poses[2].rows[11]);
        }
    }
    if (code) fprintf(stderr, "%s\n", error.message);
    cdprep_scene_end(scene);
    cdprep_workspace_end(workspace);
    for (int i = 0; i < OBJECTS; ++i) cdprep_model_close(models[i]);
    return code;
}
