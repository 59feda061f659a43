/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "c_api.h"
#include "c_asking.h"

enum { FLOOR = 3, CRATES = 31, EFFECTS = CDPREP_ASK_COLLIDE | CDPREP_ASK_DISTANCE };

static int count_sentence(void* count, const char* sentence) {
    size_t* const so_far = (size_t*)count;
    *so_far += sentence[0] != 0;
    return 1;
}

/* The second pair of layers is never asked. */
static const char* compile(const cdprep_model* cube, cdprep_plan** plan) {
    cdprep_layer_pair pairs[2];
    cdprep_model_use used;
    cdprep_plan_options options;
    cdprep_error error;
    size_t refusals = 0;
    for (int i = 0; i < 2; ++i) cdprep_layer_pair_init(&pairs[i], sizeof pairs[i]);
    cdprep_model_use_init(&used, sizeof used);
    cdprep_plan_options_init(&options, sizeof options);
    pairs[0].a = pairs[0].b = CRATES;
    pairs[1].a = CRATES;
    pairs[1].b = FLOOR;
    pairs[1].effects = EFFECTS;
    pairs[1].max_distance = 0.5;
    used.model = cube;
    used.layers = (uint32_t)1 << FLOOR | (uint32_t)1 << CRATES;
    options.layer_pairs = pairs;
    options.layer_pair_count = 2;
    options.models = &used;
    options.model_count = 1;
    options.max_objects = 3;
    options.max_pairs = 8;
    pairs[0].tolerance = -1;
    pairs[1].body = 77;
    MUST(cdprep_plan_compile(&options, count_sentence, &refusals, plan, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(refusals == 2 && *plan == NULL && error.why == CDPREP_WHY_OUT_OF_RANGE);
    MUST(strcmp(error.argument, "options.layer_pairs[0].tolerance") == 0);
    pairs[0].tolerance = 0;
    pairs[1].body = CDPREP_SURFACE;
    MUST(cdprep_plan_compile(&options, NULL, NULL, plan, &error) == CDPREP_OK);
    MUST(*plan != NULL && error.code == CDPREP_OK);
    return NULL;
}

static const char* read_plan(const cdprep_plan* plan) {
    char text[2000], start[7];
    size_t length = 0, same = 0;
    uint32_t ask = 0;
    MUST(cdprep_plan_text(plan, NULL, 0, &length, NULL) == CDPREP_OK && length > 50);
    MUST(cdprep_plan_text(plan, text, sizeof text, &same, NULL) == CDPREP_OK && same == length);
    MUST(length < sizeof text && strlen(text) == length);
    MUST(strstr(text, "layers 31 and 3: collide (mostly from distance), ") == text);
    MUST(strstr(text, "the state of a scene: ") != NULL);
    MUST(cdprep_plan_text(plan, start, sizeof start, &same, NULL) == CDPREP_OK);
    MUST(same == length && strcmp(start, "layers") == 0);
    MUST(cdprep_plan_ask(plan, FLOOR, &ask, NULL) == CDPREP_OK && ask == EFFECTS);
    MUST(cdprep_plan_ask(plan, 0, &ask, NULL) == CDPREP_OK && ask == 0);
    MUST(cdprep_plan_ask(plan, CDPREP_LAYERS, &ask, NULL) == CDPREP_BAD_ARGUMENT);
    cdprep_layer_info info;
    MUST(cdprep_plan_layer(plan, FLOOR, &info, NULL) == CDPREP_OK && info.ask == EFFECTS);
    MUST(info.reach == 0.25 && info.filter.accepts == (uint32_t)1 << CRATES);
    return NULL;
}

/* A step in which an effect of a crate and the floor begins or ends, or nothing happens. */
static const char* step_to(cdprep_scene* scene, cdprep_workspace* workspace, uint32_t hits,
                           uint32_t distances, uint32_t events) {
    cdprep_step step;
    const cdprep_scene_hit* hit = NULL;
    const cdprep_scene_distance* found = NULL;
    const cdprep_event* event = NULL;
    size_t hit_count = 9, found_count = 9, event_count = 9;
    MUST(cdprep_scene_step(scene, workspace, &step, NULL) == CDPREP_OK);
    MUST(step.complete == CDPREP_YES && step.needed_pairs == 0);
    MUST(cdprep_scene_hits(scene, &hit, &hit_count, NULL) == CDPREP_OK);
    MUST(cdprep_scene_distances(scene, &found, &found_count, NULL) == CDPREP_OK);
    MUST(cdprep_scene_events(scene, &event, &event_count, NULL) == CDPREP_OK);
    MUST(hit_count == hits && found_count == distances && event_count == events);
    for (size_t i = 0; i < hit_count; ++i) {
        MUST(hit[i].a.slot < hit[i].b.slot && hit[i].layer_pair == 1);
        MUST((hit[i].holds & ~(uint32_t)EFFECTS) == 0);
    }
    for (size_t i = 0; i < found_count; ++i) {
        MUST(found[i].layer_pair == 1 && found[i].nearest.found == CDPREP_YES);
    }
    for (size_t i = 0; i < event_count; ++i) {
        MUST(event[i].kind == CDPREP_EVENT_BEGIN || event[i].kind == CDPREP_EVENT_END);
        MUST(event[i].layer_pair == 1 && event[i].reason <= CDPREP_REASON_PAUSED);
    }
    return NULL;
}

#define STEP(hits, distances, events)                                                 \
    do {                                                                              \
        const char* const wrong = step_to(scene, workspace, hits, distances, events); \
        if (wrong != NULL) return wrong;                                              \
    } while (0)

/* Cubes of side 1: the second is 0.25 from the first, the third 9. */
static const char* fill(cdprep_scene* scene, const cdprep_model* cube, cdprep_object* ids) {
    static const double x[3] = {0, 1.25, 10};
    cdprep_object_options added[3];
    for (int i = 0; i < 3; ++i) {
        cdprep_object_options_init(&added[i], sizeof added[i]);
        added[i].model = cube;
        added[i].layer = i == 0 ? FLOOR : CRATES;
        added[i].world_from_model.rows[9] = x[i];
    }
    MUST(cdprep_scene_add(scene, added, 3, ids, NULL) == CDPREP_OK);
    MUST(ids[0].slot == 0 && ids[2].slot == 2 && ids[0].generation != 0);
    MUST(cdprep_scene_add(scene, added, 0, NULL, NULL) == CDPREP_OK);
    cdprep_object_info info;
    cdprep_object found;
    MUST(cdprep_scene_object_at(scene, 2, &found, NULL) == CDPREP_OK && found.slot == 2);
    MUST(found.generation == ids[2].generation);
    MUST(cdprep_scene_describe(scene, found, &info, NULL) == CDPREP_OK && info.model == cube);
    MUST(info.layer == CRATES && info.world_from_model.rows[9] == 10);
    return NULL;
}

/* Nothing has moved since the last step, and the boxes of the first two cubes meet. */
static const char* step_with(cdprep_scene* scene, cdprep_workspace* workspace) {
    cdprep_box_pair candidate = {0, 1};
    cdprep_step step;
    const cdprep_world_box* boxes = NULL;
    const cdprep_scene_contact* contacts = NULL;
    size_t count = 0;
    cdprep_error error;
    MUST(cdprep_scene_boxes(scene, &boxes, &count, NULL) == CDPREP_OK && count == 3);
    MUST(boxes[0].lower[0] <= -0.25F && boxes[0].upper[0] >= 1.25F); /* half of max_distance */
    MUST(boxes[1].lower[0] <= boxes[0].upper[0]);
    MUST(cdprep_scene_step_with(scene, &candidate, 1, workspace, &step, NULL) == CDPREP_OK);
    MUST(step.complete == CDPREP_YES && step.needed_contacts == 0);
    MUST(cdprep_scene_contacts(scene, &contacts, &count, NULL) == CDPREP_OK && count == 0);
    candidate.b = 0;
    MUST(cdprep_scene_step_with(scene, &candidate, 1, workspace, &step, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(error.why == CDPREP_WHY_OUT_OF_RANGE && step.complete == CDPREP_NO);
    return NULL;
}

static const char* move_objects(cdprep_scene* scene, cdprep_workspace* workspace,
                                cdprep_object* ids) {
    cdprep_pose poses[2];
    cdprep_counts counts;
    const cdprep_event* event = NULL;
    const cdprep_scene_overlap* lists = NULL;
    size_t count = 0;
    uint64_t hash = 0, again = 0;
    memset(poses, 0, sizeof poses);
    for (int i = 0; i < 2; ++i) poses[i].rows[0] = poses[i].rows[4] = poses[i].rows[8] = 1;
    STEP(1, 1, 1); /* 0.25 apart: a distance begins */
    STEP(1, 1, 0);
    MUST(cdprep_scene_hash(scene, &hash, NULL) == CDPREP_OK && hash != 0);
    MUST(cdprep_scene_hash(scene, &again, NULL) == CDPREP_OK && again == hash);
    poses[0].rows[9] = 0.5; /* the second cube hits the first: its distance is 0 */
    poses[1].rows[9] = 20;
    MUST(cdprep_scene_set_poses(scene, ids + 1, poses, 2, NULL) == CDPREP_OK);
    STEP(1, 1, 1);
    MUST(cdprep_scene_events(scene, &event, &count, NULL) == CDPREP_OK && count == 1);
    MUST(event->effect == CDPREP_ASK_COLLIDE && event->kind == CDPREP_EVENT_BEGIN);
    MUST(event->reason == CDPREP_REASON_MOVED && event->b.slot == 1);
    MUST(cdprep_scene_counts(scene, &counts, NULL) == CDPREP_OK);
    MUST(counts.n[CDPREP_SCENE_OBJECTS] == 3 && counts.n[CDPREP_SCENE_MOVED] == 2);
    MUST(counts.n[CDPREP_SCENE_CANDIDATES] == 1);
    MUST(counts.n[CDPREP_SCENE_COLLIDE] == 0); /* the distance told it */
    MUST(counts.n[CDPREP_SCENE_WITHIN] == 0 && counts.n[CDPREP_SCENE_DISTANCE] == 1);
    MUST(cdprep_scene_set_paused(scene, CDPREP_ASK_RAY, NULL) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_scene_set_paused(scene, CDPREP_ASK_COLLIDE, NULL) == CDPREP_OK);
    STEP(1, 1, 1);
    MUST(cdprep_scene_events(scene, &event, &count, NULL) == CDPREP_OK);
    MUST(event->kind == CDPREP_EVENT_END && event->reason == CDPREP_REASON_PAUSED);
    MUST(cdprep_scene_set_paused(scene, 0, NULL) == CDPREP_OK);
    STEP(1, 1, 1);
    MUST(cdprep_scene_overlaps(scene, &lists, &count, NULL) == CDPREP_OK && count == 0);
    MUST(cdprep_scene_set_layer(scene, ids[1], 0, NULL) == CDPREP_OK);
    STEP(0, 0, 2);
    MUST(cdprep_scene_events(scene, &event, &count, NULL) == CDPREP_OK);
    MUST(event->kind == CDPREP_EVENT_END && event->reason == CDPREP_REASON_RELAYERED);
    MUST(cdprep_scene_set_layer(scene, ids[1], CRATES, NULL) == CDPREP_OK);
    STEP(1, 1, 2);
    {
        const char* const wrong = step_with(scene, workspace);
        if (wrong != NULL) return wrong;
    }
    MUST(cdprep_scene_remove(scene, ids, 2, NULL) == CDPREP_OK);
    STEP(0, 0, 2);
    MUST(cdprep_scene_events(scene, &event, &count, NULL) == CDPREP_OK);
    MUST(event->reason == CDPREP_REASON_REMOVED);
    return NULL;
}

static const char* run_scene(cdprep_plan* plan, const cdprep_model* cube,
                             cdprep_workspace* workspace, void* memory, size_t size) {
    cdprep_scene* scene = NULL;
    cdprep_object ids[3];
    cdprep_error error;
    size_t needed = 0;
    const char* wrong = NULL;
    MUST(cdprep_scene_size(plan, &needed, NULL) == CDPREP_OK && needed > 0);
    if (memory != NULL && size < needed) {
        MUST(cdprep_scene_make(plan, memory, size, &scene, &error) == CDPREP_BAD_ARGUMENT);
        MUST(error.why == CDPREP_WHY_TOO_SMALL && scene == NULL);
        return NULL;
    }
    MUST(cdprep_scene_make(plan, memory, size, &scene, NULL) == CDPREP_OK);
    wrong = fill(scene, cube, ids);
    if (wrong == NULL) wrong = move_objects(scene, workspace, ids);
    cdprep_scene_end(scene);
    return wrong;
}

const char* ask_scene(const cdprep_model* cube, cdprep_workspace* workspace, void* memory,
                      size_t size) {
    cdprep_plan* plan = NULL;
    const char* wrong = compile(cube, &plan);
    if (wrong == NULL) wrong = read_plan(plan);
    if (wrong == NULL) wrong = run_scene(plan, cube, workspace, NULL, 0);
    if (wrong == NULL) wrong = run_scene(plan, cube, workspace, memory, size);
    if (wrong == NULL) wrong = run_scene(plan, cube, workspace, memory, 64);
    cdprep_plan_end(plan);
    return wrong;
}

static const char* update_boxes(cdprep_broad_phase* broad_phase, cdprep_workspace* workspace) {
    cdprep_world_box boxes[3] = {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{5}, {6, 1, 1}}};
    cdprep_box_filter filters[3] = {{1, 1}, {1, 1}, {1, 1}};
    const uint32_t last = 2;
    cdprep_box_update update;
    cdprep_box_pairs pairs;
    cdprep_box_update_init(&update, sizeof update);
    update.boxes = boxes;
    update.count = 3;
    MUST(cdprep_broad_phase_update(broad_phase, &update, workspace, &pairs, NULL) == CDPREP_OK);
    MUST(pairs.complete == CDPREP_YES && pairs.count == 1 && pairs.needed == 0);
    MUST(pairs.items[0].a == 0 && pairs.items[0].b == 1); /* they touch in a corner */
    boxes[2].lower[0] = 1.5F;
    update.moved = &last;
    update.moved_count = 1;
    update.filters = filters;
    MUST(cdprep_broad_phase_update(broad_phase, &update, workspace, &pairs, NULL) == CDPREP_OK);
    MUST(pairs.count == 2 && pairs.items[1].a == 1 && pairs.items[1].b == 2);
    filters[2].accepts = 2;
    MUST(cdprep_broad_phase_update(broad_phase, &update, workspace, &pairs, NULL) == CDPREP_OK);
    MUST(pairs.count == 1 && pairs.items[0].b == 1);
    filters[2].accepts = 1;
    boxes[2].lower[0] = 0.5F; /* three pairs, and room for two */
    MUST(cdprep_broad_phase_update(broad_phase, &update, workspace, &pairs, NULL) == CDPREP_OK);
    MUST(pairs.complete == CDPREP_NO && pairs.count == 0 && pairs.needed == 3);
    return NULL;
}

const char* ask_broad_phase(cdprep_workspace* workspace, void* memory, size_t size) {
    cdprep_broad_phase_options options;
    cdprep_broad_phase* broad_phase = NULL;
    size_t needed = 0;
    const char* wrong = NULL;
    cdprep_broad_phase_options_init(&options, sizeof options);
    options.max_boxes = 3;
    options.max_pairs = 2;
    MUST(cdprep_broad_phase_size(&options, &needed, NULL) == CDPREP_OK);
    MUST(needed > 0 && needed <= size);
    for (int i = 0; i < 2 && wrong == NULL; ++i) {
        MUST(cdprep_broad_phase_make(&options, i == 0 ? NULL : memory, i == 0 ? 0 : size,
                                     &broad_phase, NULL) == CDPREP_OK);
        wrong = update_boxes(broad_phase, workspace);
        cdprep_broad_phase_end(broad_phase);
    }
    return wrong;
}
