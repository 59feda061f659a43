/* SPDX-License-Identifier: MIT */
/* The collisions of a game: two bodies fall into a level. All memory comes from one arena, which
 * is closed after loading.
 *
 *     cdprep bake tray.obj crate.obj jack.obj --effects contacts,overlap,corners
 *     sample_game tray.cdp.h5 crate.cdp.h5 jack.cdp.h5 */
#include <stdint.h>
#include <stdio.h>

#include "cdprep/cdprep.h"

enum { LEVEL, BODIES, OBJECTS = 3 }; /* two layers, and the number of objects */
enum { FRAMES = 120, MAX_LINES = 6000 };
static const double frame_s = 1.0 / 60, gravity = -9.81;

static struct {
    unsigned char bytes[32 << 20];
    size_t used;
    int is_closed;
} arena;

static void* take(void* context, size_t size, size_t alignment) {
    const uintptr_t begin = (uintptr_t)arena.bytes, end = begin + sizeof arena.bytes;
    const uintptr_t place = (begin + arena.used + alignment - 1) & ~(uintptr_t)(alignment - 1);
    (void)context;
    if (arena.is_closed || place > end || size > end - place) return NULL;
    arena.used = place + size - begin;
    return (void*)place;
}

/* The arena is released as a whole. */
static void keep(void* context, void* memory, size_t size) {
    (void)context, (void)memory, (void)size;
}

static const cdprep_allocator allocator = {take, keep, NULL};

typedef struct object {
    cdprep_model* model;
    cdprep_object id;
    cdprep_pose pose;
    double velocity[3];
} object;

static object objects[OBJECTS]; /* by slot; the first is the level */
static float lines[MAX_LINES][2][3];
static size_t line_count, contact_count;

static int load(const char* path, cdprep_model** model, cdprep_error* error) {
    cdprep_open_options options;
    FILE* const file = fopen(path, "rb");
    unsigned char* bytes = NULL;
    long size = 0;
    int is_read = file && !fseek(file, 0, SEEK_END) && (size = ftell(file)) > 0;
    is_read = is_read && (bytes = take(NULL, (size_t)size, CDPREP_ALIGNMENT)) != NULL;
    is_read = is_read && !fseek(file, 0, SEEK_SET) && fread(bytes, (size_t)size, 1, file) == 1;
    if (file) fclose(file);
    if (!is_read) {
        snprintf(error->message, sizeof error->message, "%s cannot be read into the arena.", path);
        return CDPREP_UNREADABLE;
    }
    cdprep_open_options_init(&options, sizeof options);
    options.ask = CDPREP_ASK_CONTACTS | CDPREP_ASK_OVERLAP | CDPREP_ASK_CORNERS;
    options.name = path;
    options.allocator = &allocator;
    return cdprep_model_open_memory(bytes, (size_t)size, &options, model, error);
}

/* The level is asked about bodies, and bodies about each other. */
static int make_scene(cdprep_scene** scene, cdprep_error* error) {
    cdprep_contact_options contacts;
    cdprep_layer_pair pairs[2];
    cdprep_plan_options options;
    cdprep_plan* plan = NULL;
    int code;
    cdprep_contact_options_init(&contacts, sizeof contacts);
    contacts.most = 16;
    contacts.cluster_angle = 0.26; /* 15 degrees */
    for (int i = 0; i < 2; ++i) {
        cdprep_layer_pair_init(&pairs[i], sizeof pairs[i]);
        pairs[i].a = i == 0 ? LEVEL : BODIES;
        pairs[i].b = BODIES;
        pairs[i].effects = CDPREP_ASK_CONTACTS | CDPREP_ASK_OVERLAP;
        pairs[i].contacts = &contacts;
    }
    cdprep_plan_options_init(&options, sizeof options);
    options.layer_pairs = pairs;
    options.layer_pair_count = 2;
    options.max_objects = OBJECTS;
    options.max_pairs = 2 * OBJECTS;
    options.max_triangle_pairs = MAX_LINES / 6;
    options.max_contacts = 16 * OBJECTS;
    options.allocator = &allocator;
    if (!(code = cdprep_plan_compile(&options, NULL, NULL, &plan, error))) {
        code = cdprep_scene_make(plan, NULL, 0, scene, error);
    }
    cdprep_plan_end(plan);
    return code;
}

static int fill(cdprep_scene* scene, cdprep_error* error) {
    for (int i = 0; i < OBJECTS; ++i) {
        cdprep_object_options options;
        int code;
        cdprep_object_options_init(&options, sizeof options);
        options.model = objects[i].model;
        options.layer = i == 0 ? LEVEL : BODIES;
        if (i > 0) options.world_from_model.rows[9] = 0.3 * i - 0.4; /* x */
        if (i > 0) options.world_from_model.rows[11] = 1.2 * i;      /* z */
        objects[i].pose = options.world_from_model;
        if ((code = cdprep_scene_add(scene, &options, 1, &objects[i].id, error))) return code;
    }
    return CDPREP_OK;
}

static double dot(const double* a, const double* b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Moves a body out along a normal, as far as earlier contacts have not, and ends its approach. */
static void push(object* body, double* moved, const double* normal, double way) {
    const double rest = way - dot(moved, normal), speed = dot(body->velocity, normal);
    for (int axis = 0; axis < 3; ++axis) {
        if (rest > 0) moved[axis] += rest * normal[axis];
        if (rest > 0) body->pose.rows[9 + axis] += rest * normal[axis];
        if (speed < 0) body->velocity[axis] -= speed * normal[axis];
    }
}

static void respond(const cdprep_scene_contact* pair) {
    double moved_a[3] = {0}, moved_b[3] = {0};
    const double share = pair->a.slot == 0 ? 1 : 0.5; /* the level stands */
    for (size_t i = 0; i < pair->count; ++i) {
        const cdprep_contact* const contact = &pair->items[i];
        double back[3];
        if (contact->flags & CDPREP_CONTACT_FROM_BEHIND) continue;
        for (int axis = 0; axis < 3; ++axis) back[axis] = -contact->normal[axis];
        push(&objects[pair->b.slot], moved_b, contact->normal, -contact->lower * share);
        if (pair->a.slot > 0) push(&objects[pair->a.slot], moved_a, back, -contact->lower * share);
    }
    contact_count += pair->count;
}

/* Adds the edges of a triangle to the lines that the renderer draws. */
static int draw(const object* of, uint32_t triangle, cdprep_error* error) {
    cdprep_corners corners;
    double world[3][3];
    int code;
    if ((code = cdprep_model_corners(of->model, &triangle, 1, &corners, error))) return code;
    if ((code = cdprep_pose_move(&of->pose, corners.point[0], 3, world[0], error))) return code;
    for (int edge = 0; edge < 3 && line_count < MAX_LINES; ++edge, ++line_count) {
        for (int axis = 0; axis < 3; ++axis) {
            lines[line_count][0][axis] = (float)world[edge][axis];
            lines[line_count][1][axis] = (float)world[(edge + 1) % 3][axis];
        }
    }
    return CDPREP_OK;
}

static int step(cdprep_scene* scene, cdprep_workspace* workspace, cdprep_error* error) {
    const cdprep_scene_overlap* overlaps;
    const cdprep_scene_contact* contacts;
    size_t overlap_pairs, contact_pairs;
    cdprep_step done;
    int code = CDPREP_OK;
    for (int i = 1; i < OBJECTS && !code; ++i) {
        objects[i].velocity[2] += gravity * frame_s;
        for (int axis = 0; axis < 3; ++axis) {
            objects[i].pose.rows[9 + axis] += objects[i].velocity[axis] * frame_s;
        }
        code = cdprep_scene_set_poses(scene, &objects[i].id, &objects[i].pose, 1, error);
    }
    if (code || (code = cdprep_scene_step(scene, workspace, &done, error))) return code;
    line_count = contact_count = 0;
    if (done.complete == CDPREP_NO) return puts("The plan has too little room."), CDPREP_OK;
    if ((code = cdprep_scene_overlaps(scene, &overlaps, &overlap_pairs, error))) return code;
    for (size_t i = 0; i < overlap_pairs && !code; ++i) {
        for (size_t k = 0; k < overlaps[i].count && !code; ++k) {
            code = draw(&objects[overlaps[i].a.slot], overlaps[i].items[k].a, error);
            if (!code) code = draw(&objects[overlaps[i].b.slot], overlaps[i].items[k].b, error);
        }
    }
    if (code || (code = cdprep_scene_contacts(scene, &contacts, &contact_pairs, error)))
        return code;
    for (size_t i = 0; i < contact_pairs; ++i) respond(&contacts[i]);
    return CDPREP_OK;
}

static int play(cdprep_scene* scene, cdprep_workspace* workspace, cdprep_error* error) {
    int code = CDPREP_OK;
    for (int frame = 0; frame < FRAMES && !code; ++frame) {
        code = step(scene, workspace, error);
        if (frame % 20 != 19) continue;
        printf("frame %d: %u contacts, %u lines, heights %.3f %.3f\n", frame,
               (unsigned)contact_count, (unsigned)line_count, objects[1].pose.rows[11],
               objects[2].pose.rows[11]);
    }
    return code;
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
    for (int i = 0; i < OBJECTS && !code; ++i) code = load(argv[1 + i], &objects[i].model, &error);
    if (!code && !(code = cdprep_workspace_make(&options, NULL, 0, &workspace, &error)) &&
        !(code = make_scene(&scene, &error)) && !(code = fill(scene, &error))) {
        arena.is_closed = 1;
        printf("%u KiB in use\n", (unsigned)(arena.used >> 10));
        code = play(scene, workspace, &error);
    }
    if (code) fprintf(stderr, "%s\n", error.message);
    cdprep_scene_end(scene);
    cdprep_workspace_end(workspace);
    for (int i = 0; i < OBJECTS; ++i) cdprep_model_close(objects[i].model);
    return code;
}
