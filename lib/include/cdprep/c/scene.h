/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_SCENE_H
#define CDPREP_C_SCENE_H

#include "cdprep/c/contacts.h"
#include "cdprep/c/motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Many objects that move, and the broad phase.
 *
 * A plan states what a scene computes. A scene holds objects, and runs the queries of its plan at
 * each step. The broad phase finds the pairs of boxes that meet. Each scene has its own broad
 * phase. */

/* --- Plans ------------------------------------------------------------------------------------ */

enum { CDPREP_LAYERS = 32 }; /* the number of layers of a scene; an object is in one of them */

/* The effects for pairs of objects of two layers. The two layers may be the same. No other pair may
 * have the same two layers.
 *
 * CDPREP_ASK_SELF tests each object of one layer against itself: `a` and `b` are both that layer.
 * CDPREP_ASK_CONTINUOUS finds when two objects touch on the way from their last poses to the
 * present ones. CDPREP_ASK_HAPTIC computes a distance within a limit of work. CDPREP_ASK_DEFORM and
 * CDPREP_ASK_TEAR compute nothing. They state that models of the layers may change between two
 * steps, so that each step looks for changes. A pair with either of them must not have
 * CDPREP_ASK_CONTACTS or _CONTINUOUS. A pair with CDPREP_ASK_HAPTIC must not have
 * CDPREP_ASK_DISTANCE or CDPREP_SOLID.
 *
 * With `max_error`, the plan chooses the cheapest method that is certified for every model of both
 * layers. The choice depends on numbers in the files and in cdprep_model_use, never on a measured
 * time. One method is the search through the BVH, which ends at max_error. The other is for
 * CDPREP_SOLID: the distance between enclosing parts (bake --structures hull --parts N). This
 * method has three conditions. The product of the models' part counts is at most 6. The sum of the
 * models' errors is at most max_error. Neither layer is in a pair with CDPREP_ASK_DEFORM or _TEAR.
 * With this method, the nearest points lie on parts, and the triangles are CDPREP_NONE. Two objects
 * still use the BVH if one of their models has no parts. They also do so if the sum of their parts'
 * errors exceeds the error that the plan certified. With either method, the bounds contain the
 * exact distance. They are at most max_error apart, plus rounding. Rounding is at most 3e-12 of
 * `upper`, plus 1e-13 of the largest coordinate of a model or a translation.
 *
 * With `max_error`, an effect that is reported not to hold does not hold. An effect may be reported
 * to hold although the exact distance exceeds its limit by up to max_error, plus rounding. The
 * limits are 0 for collide, max_distance for distance and tolerance for within. CDPREP_ASK_WITHIN
 * is exact unless the pair also has CDPREP_ASK_DISTANCE and CDPREP_SURFACE. CDPREP_ASK_COLLIDE is
 * exact unless parts decide it; then no containment is reported. While distance is paused, both are
 * exact. `max_error` changes no other effect. */
typedef struct cdprep_layer_pair {
    cdprep_head head;
    uint32_t a, b; /* 0: below CDPREP_LAYERS */
    /* 0: nothing is computed. Bits: CDPREP_ASK_COLLIDE, _OVERLAP, _WITHIN, _DISTANCE, _CONTACTS,
     * _CONTINUOUS, _SELF, _HAPTIC, _DEFORM, _TEAR */
    uint32_t effects;
    /* CDPREP_SURFACE; for collide, distance, contacts and continuous. */
    uint32_t body;
    uint32_t overlap; /* CDPREP_CLOSED; for collide and overlap */
    /* CDPREP_NO. CDPREP_YES: each step also lists an event for each effect that goes on. */
    uint32_t lists_stays;
    double tolerance; /* 0: for within, model units */
    /* 0: for distance and haptic, model units. Objects that are proven to be farther apart are left
     * out. */
    double max_distance;
    /* 0: for distance, model units: the largest permitted error of answers; see above. */
    double max_error;
    /* Null; for contacts: the options. Null means the defaults, but with `most` = 16. Read only
     * during the call. */
    const cdprep_contact_options* contacts;
    double impact_tolerance; /* 0: for continuous: cdprep_moving_pair.tolerance */
    /* 0: for haptic, which needs at least 1: `work` of cdprep_distance_bounded(). */
    uint64_t work;
    uint32_t impact_steps; /* 256: for continuous: cdprep_moving_pair.most_steps */
    uint32_t reserved;     /* 0 */
} cdprep_layer_pair;

CDPREP_API void cdprep_layer_pair_init(cdprep_layer_pair* pair, size_t size);

/* A model that a scene will use. cdprep_plan_compile() refuses a model that does not serve the
 * effects of `layers`. */
typedef struct cdprep_model_use {
    cdprep_head head;
    const cdprep_model* model; /* null: `serves` is used */
    const char* name;          /* null: the name of a model that is not open, for messages; UTF-8 */
    /* 0: if `model` is null, the CDPREP_ASK_ bits that it will serve. */
    uint32_t serves;
    uint32_t layers; /* 0: the layers of its objects; bit i is layer i */
    /* 0: if `model` is null, the number of enclosing parts of a balanced model with one component.
     * They count only if `serves` has CDPREP_ASK_HULLS. If `model` is not null, the plan reads its
     * parts from the model. For this, the model must be opened with CDPREP_ASK_HULLS and _SOLID. */
    uint32_t part_count;
    uint32_t reserved; /* 0 */
    double part_error; /* 0: with part_count, the largest error of those parts, model units */
} cdprep_model_use;

CDPREP_API void cdprep_model_use_init(cdprep_model_use* model_use, size_t size);

/* The options of a plan: what a scene computes, and its limits. The arrays are read only during the
 * call. */
typedef struct cdprep_plan_options {
    cdprep_head head;
    const cdprep_layer_pair* layer_pairs; /* null */
    const cdprep_model_use* models;       /* null: only the scene checks models */
    /* Null: messages and texts number the layers. Otherwise the names of layers 0, 1, ..., in
     * UTF-8; copied. A layer with an empty name is named by its number. */
    const char* const* layer_names;
    uint32_t layer_pair_count; /* 0: at most 528 */
    uint32_t model_count;      /* 0 */
    uint32_t layer_name_count; /* 0: at most CDPREP_LAYERS */
    uint32_t max_objects;      /* 0: objects of a scene, at most 2^29 */
    /* 0: the maximum number of pairs of objects whose boxes meet at a time. An object that is
     * tested against itself counts as a pair. Room for twice as many makes steps faster. */
    uint32_t max_pairs;
    /* 1: at most 256. A step uses at most this many lanes of its workspace. */
    uint32_t lanes;
    uint32_t max_triangle_pairs; /* 0: for overlap and self: the total of all lists of a step */
    uint32_t max_contacts;       /* 0: for contacts, likewise */
    /* Null: the heap; copied. Scenes with this plan use it too. */
    const cdprep_allocator* allocator;
    /* 0: a point near the objects. Their boxes are relative to it, so that they stay tight in
     * float. The point changes which boxes meet, and so how many pairs need room. It changes no
     * result, except what CDPREP_ASK_HAPTIC keeps from earlier steps. */
    double origin[3];
} cdprep_plan_options;

CDPREP_API void cdprep_plan_options_init(cdprep_plan_options* options, size_t size);

/* A compiled plan. It is read-only: any number of scenes and threads may use it. */
typedef struct cdprep_plan cdprep_plan;

/* Receives a sentence, as a string that ends with a zero byte, and the caller's context. Returning
 * 0 ends the visits. */
typedef int (*cdprep_text_visitor)(void* context, const char* sentence);

/* Compiles a plan. Invalid layer pairs and models do not end the checks. Exception: an invalid head
 * of an array's first element ends the checks of that array. `refusals` receives a sentence for
 * each invalid layer pair or model, and `error` describes the first. If another field of the
 * options is invalid, only `error` describes it. `refusals` may be null. On failure *plan is null.
 * The plan takes some kilobytes. Takes O(layer pairs (layer pairs + models)) time.
 * Errors, which name the argument, such as `options.layer_pairs[3].tolerance`:
 * - CDPREP_WHY_OUT_OF_RANGE: a layer, an effect, an enumerator, a number or a count.
 * - CDPREP_WHY_NULL: a name of a layer, a function of the allocator, or an array with a count above
 *   0 is null.
 * - CDPREP_WHY_NOT_FINITE: a tolerance, an error, an angle, `max_distance` or the origin is NaN or
 *   infinite.
 * - CDPREP_WHY_NO_MEANING: two pairs have the same layers. Or a field is set that no effect of its
 *   pair uses. Or, although a model is given, `serves`, `name`, `part_count` or `part_error` is
 *   set. Or `part_error` is set without `part_count`.
 * - CDPREP_WHY_NOT_BAKED: a model does not serve an effect of its `layers`, because its file lacks
 *   the sections. If `model` is null: because `serves` lacks the effect.
 * - CDPREP_WHY_NOT_OPENED: a model does not serve an effect of its `layers`, because the sections
 *   were not opened.
 * - CDPREP_OVER_BUDGET: there is not enough memory. */
CDPREP_API int cdprep_plan_compile(const cdprep_plan_options* options, cdprep_text_visitor refusals,
                                   void* context, cdprep_plan** plan, cdprep_error* error);

/* Stores a text of several lines that describes a plan. It lists the queries of each layer pair,
 * and the effects that are not computed. It lists layers that are never tested together. It lists
 * layers in no pair only if they have a name or a model. Then it lists the sections that are read,
 * and the size of a scene. *length is the length of the whole text, without the zero at its end.
 * Stores at most `room` - 1 characters, and a zero. `text` may be null if `room` is 0. */
CDPREP_API int cdprep_plan_text(const cdprep_plan* plan, char* text, size_t room, size_t* length,
                                cdprep_error* error);

/* Stores the CDPREP_ASK_ bits that the models of a layer must serve. Open them for these bits. */
CDPREP_API int cdprep_plan_ask(const cdprep_plan* plan, uint32_t layer, uint32_t* ask,
                               cdprep_error* error);

/* Ends a plan. Null does nothing. Scenes of the plan may still run: its memory is released when the
 * last of them ends. */
CDPREP_API void cdprep_plan_end(cdprep_plan* plan);

/* --- Scenes -----------------------------------------------------------------------------------
 *
 * A step runs the plan's queries for pairs of objects near each other. If nothing about a pair has
 * changed since the last step, its results are kept. Without max_error, the results are those of
 * single queries with CDPREP_MOVE_BOTH. Results do not depend on the number of lanes, and are
 * sorted by the slots of `a` and `b`. */

/* Objects and their results. While one call changes a scene, all other calls on it fail with
 * CDPREP_WHY_BUSY; cdprep_scene_end() then does nothing. Any number of threads may read a scene at
 * the same time. Do not change it while another thread reads it: this is not checked. Its models
 * must stay open until it ends. */
typedef struct cdprep_scene cdprep_scene;

/* The id of an object. A slot that is used again gets a new generation. All 0: no object. */
typedef struct cdprep_object {
    uint32_t slot; /* below cdprep_plan_options.max_objects */
    uint32_t generation;
} cdprep_object;

/* Stores the number of bytes that cdprep_scene_make() needs for this plan. It depends on the limits
 * and on the layer pairs: their number, effects, `body`, cdprep_contact_options.most and method for
 * max_error. It is about 460 to 620 bytes for each object and 360 to 2,450 for each pair.
 * CDPREP_ASK_HAPTIC takes 2,300 more for each pair. CDPREP_ASK_OVERLAP and _SELF take 24 more for
 * each triangle pair, and 16 KiB for each lane. CDPREP_ASK_CONTACTS takes 1,630 more for each
 * contact, and 16 to 120 KiB for each lane. On failure *size is 0.
 * Errors: CDPREP_OVER_BUDGET: the scene is larger than memory can be, with pointers of 32 bits. */
CDPREP_API int cdprep_scene_size(const cdprep_plan* plan, size_t* size, cdprep_error* error);

/* Makes an empty scene in the caller's memory. The memory must start at a multiple of
 * CDPREP_ALIGNMENT, have at least cdprep_scene_size() bytes, and outlive the scene. If `memory` is
 * null and `size` is 0, the scene takes its memory from the plan's allocator, in one allocation. On
 * failure *scene is null. No other function of a scene allocates, except for the message of an
 * error or of a motion that is too long.
 * Errors: CDPREP_WHY_TOO_SMALL; CDPREP_WHY_OUT_OF_RANGE for the alignment; CDPREP_OVER_BUDGET. */
CDPREP_API int cdprep_scene_make(cdprep_plan* plan, void* memory, size_t size, cdprep_scene** scene,
                                 cdprep_error* error);

/* Ends a scene and releases the memory that cdprep_scene_make() allocated. Does nothing for null or
 * a scene in use. */
CDPREP_API void cdprep_scene_end(cdprep_scene* scene);

/* An object to add. */
typedef struct cdprep_object_options {
    cdprep_head head;
    const cdprep_model* model;    /* must serve the bits of cdprep_plan_ask() for `layer` */
    uint32_t layer;               /* 0: below CDPREP_LAYERS */
    uint32_t reserved;            /* 0 */
    cdprep_pose world_from_model; /* identity */
} cdprep_object_options;

CDPREP_API void cdprep_object_options_init(cdprep_object_options* options, size_t size);

/* Adds `count` objects, each to the lowest free slot, and stores their ids. If one is invalid, none
 * is added, and all ids are 0. The size in the head of the first object is the stride of the array.
 * Errors, which name the argument, such as `objects[3].world_from_model`:
 * - CDPREP_WHY_NOT_BAKED, CDPREP_WHY_NOT_OPENED: a model does not serve its layer.
 * - CDPREP_WHY_NOT_RIGID, CDPREP_WHY_NOT_FINITE: a pose.
 * - CDPREP_WHY_OUT_OF_RANGE: a layer or a pose. Or `count` exceeds the free slots of the scene.
 * - CDPREP_WHY_BUSY. */
CDPREP_API int cdprep_scene_add(cdprep_scene* scene, const cdprep_object_options* objects,
                                size_t count, cdprep_object* ids, cdprep_error* error);

/* Removes objects. The next step lists the end of each effect that held for them. An id may repeat.
 * Errors: CDPREP_WHY_STALE for an object that does not exist; then none is removed. */
CDPREP_API int cdprep_scene_remove(cdprep_scene* scene, const cdprep_object* ids, size_t count,
                                   cdprep_error* error);

/* Moves an object to another layer.
 * Errors: CDPREP_WHY_STALE; CDPREP_WHY_OUT_OF_RANGE for the layer; CDPREP_WHY_NOT_BAKED or
 * CDPREP_WHY_NOT_OPENED as in cdprep_scene_add(). */
CDPREP_API int cdprep_scene_set_layer(cdprep_scene* scene, cdprep_object id, uint32_t layer,
                                      cdprep_error* error);

/* Sets the poses of objects, from model to world coordinates: poses[i] is that of ids[i]. If an id
 * repeats, its last pose counts. An object counts as moved even if its pose is the same. For
 * CDPREP_ASK_CONTINUOUS, the object moves from its pose in the last complete step to the new pose.
 * If cdprep_scene_add() or cdprep_scene_put() set its pose since then, the motion begins at that
 * pose. The middle of its model's box moves along a straight line. The object turns the shorter
 * way, by pi at most.
 * Errors: CDPREP_WHY_STALE, CDPREP_WHY_NOT_FINITE, CDPREP_WHY_OUT_OF_RANGE, CDPREP_WHY_NOT_RIGID;
 * then no pose is set. */
CDPREP_API int cdprep_scene_set_poses(cdprep_scene* scene, const cdprep_object* ids,
                                      const cdprep_pose* poses, size_t count, cdprep_error* error);

/* Sets poses as cdprep_scene_set_poses() does, but without a motion for CDPREP_ASK_CONTINUOUS: the
 * objects jump to the new poses. Errors: those of cdprep_scene_set_poses(). */
CDPREP_API int cdprep_scene_put(cdprep_scene* scene, const cdprep_object* ids,
                                const cdprep_pose* poses, size_t count, cdprep_error* error);

/* An object as it is now. */
typedef struct cdprep_object_info {
    const cdprep_model* model;
    uint32_t layer;
    uint32_t reserved; /* 0 */
    cdprep_pose world_from_model;
} cdprep_object_info;

/* Stores the model, the layer and the pose of an object, in O(1) time. On failure, info->model is
 * null. Errors: CDPREP_WHY_STALE; CDPREP_WHY_BUSY. */
CDPREP_API int cdprep_scene_describe(const cdprep_scene* scene, cdprep_object id,
                                     cdprep_object_info* info, cdprep_error* error);

/* Stores the id of the object in a slot, or all 0 if the slot is free. Takes O(1) time.
 * Errors: CDPREP_WHY_OUT_OF_RANGE for a slot that is not below max_objects; CDPREP_WHY_BUSY. */
CDPREP_API int cdprep_scene_object_at(const cdprep_scene* scene, uint32_t slot, cdprep_object* id,
                                      cdprep_error* error);

/* Pauses these effects from the next step on, and resumes all others. Paused effects are not
 * computed. If one held, the next step lists its end.
 * Errors: CDPREP_WHY_OUT_OF_RANGE for an effect that the plan does not ask for; CDPREP_WHY_BUSY. */
CDPREP_API int cdprep_scene_set_paused(cdprep_scene* scene, uint32_t effects, cdprep_error* error);

typedef struct cdprep_step {
    /* 0, or the max_pairs that this step needs, if that of the plan is too small. */
    uint64_t needed_pairs;
    uint64_t needed_triangle_pairs; /* max_triangle_pairs, likewise */
    uint64_t needed_contacts;       /* max_contacts, likewise */
    uint32_t complete;    /* CDPREP_NO: there is too little room; the step has changed nothing */
    uint32_t reserved[9]; /* 0 */
} cdprep_step;

/* Computes the effects of all objects as they are now, on the lanes of the workspace. Too little
 * room is no error: then `complete` is CDPREP_NO. Takes O(n + pairs) time if few objects move far,
 * plus the time of the queries.
 * Errors: CDPREP_WHY_BUSY for the scene or the workspace. Then `complete` is CDPREP_NO. */
CDPREP_API int cdprep_scene_step(cdprep_scene* scene, cdprep_workspace* workspace,
                                 cdprep_step* step, cdprep_error* error);

/* Two objects for which an effect holds: a.slot < b.slot. For self, a and b are the same object.
 *
 * Collide holds if collision.hit is CDPREP_YES. Within holds up to `tolerance`, and distance up to
 * `max_distance`. Overlap, self and contacts hold if their lists have items. Continuous holds
 * unless the kind of the impact is CDPREP_IMPACT_NONE. Haptic holds unless the distance is proven
 * to exceed max_distance. */
typedef struct cdprep_scene_hit {
    cdprep_object a, b;
    uint32_t layer_pair; /* index into cdprep_plan_options.layer_pairs */
    /* CDPREP_ASK_ bits of the effects that hold. It is 0 if `collision.hit` is CDPREP_UNKNOWN and
     * no other effect holds. */
    uint32_t holds;
    cdprep_collision collision; /* the answer of collide */
} cdprep_scene_hit;

/* All pairs of overlapping triangles of two objects: a.slot < b.slot. */
typedef struct cdprep_scene_overlap {
    cdprep_object a, b;
    uint32_t layer_pair;
    uint32_t reserved;           /* 0 */
    const cdprep_overlap* items; /* belongs to the scene; in the order of (a, b) */
    size_t count;
} cdprep_scene_overlap;

/* The distance of two objects that are at most max_distance apart: a.slot < b.slot. With max_error,
 * they may be that much farther apart. */
typedef struct cdprep_scene_distance {
    cdprep_object a, b;
    uint32_t layer_pair;
    uint32_t reserved;      /* 0 */
    cdprep_nearest nearest; /* points are in the world; see cdprep_layer_pair.max_error */
} cdprep_scene_distance;

/* The triangles of one object that overlap each other. */
typedef struct cdprep_scene_self_overlap {
    cdprep_object id;
    uint32_t layer_pair;
    uint32_t reserved;           /* 0 */
    const cdprep_overlap* items; /* belongs to the scene; in the order of (a, b) */
    size_t count;
} cdprep_scene_self_overlap;

/* The time at which two objects first touch, between the last step's poses and the present ones:
 * a.slot < b.slot. If a motion is too long to compute, the kind is CDPREP_IMPACT_UNFINISHED and
 * `lower` is 0. */
typedef struct cdprep_scene_impact {
    cdprep_object a, b;
    uint32_t layer_pair;
    uint32_t reserved;    /* 0 */
    cdprep_impact impact; /* times from 0 to 1; points are in the world */
} cdprep_scene_impact;

/* The distance of two objects for CDPREP_ASK_HAPTIC: a.slot < b.slot. Objects that are proven to be
 * farther apart than max_distance are left out. */
typedef struct cdprep_scene_bounded {
    cdprep_object a, b;
    uint32_t layer_pair;
    /* CDPREP_YES: there was a complete answer since the boxes of the two objects met. */
    uint32_t has_last;
    /* The number of late answers since the last complete one or, without one, since the boxes
     * met. */
    uint64_t late;
    cdprep_bounded bounded;               /* points are in the world */
    cdprep_bounded last;                  /* the last complete answer, if has_last */
    cdprep_pose last_pose_a, last_pose_b; /* the poses of that answer */
} cdprep_scene_bounded;

/* The contacts of two objects: a.slot < b.slot. A is the object with the lower slot. Points and
 * normals are in world coordinates. The other fields are those of a cdprep_contact_list. If `work`
 * ended the search for two objects, they are listed even without contacts. */
typedef struct cdprep_scene_contact {
    cdprep_object a, b;
    uint32_t layer_pair;
    uint32_t complete;           /* CDPREP_NO if `most` or `work` left contacts out */
    uint32_t searched;           /* CDPREP_NO if `work` ended the search for near triangles */
    uint32_t reserved;           /* 0 */
    const cdprep_contact* items; /* belongs to the scene; the deepest first */
    size_t count;
    uint64_t found, computed, work;
} cdprep_scene_contact;

/* The kind of an event. For two objects and one effect, each begin is followed by one end before
 * the next begin. */
enum {
    CDPREP_EVENT_BEGIN = 1,
    CDPREP_EVENT_STAY = 2, /* only with lists_stays */
    CDPREP_EVENT_END = 4
};
/* The reason of an event. */
enum {
    /* An object moved, changed or was added, or cdprep_scene_step_with() got other pairs than in
     * the last step. With CDPREP_ASK_CONTINUOUS, an object also counts as moved in the step after
     * its last motion. */
    CDPREP_REASON_MOVED = 0,
    CDPREP_REASON_REMOVED = 1,   /* an object was removed */
    CDPREP_REASON_RELAYERED = 2, /* an object is in another layer than in the last step */
    CDPREP_REASON_PAUSED = 3,    /* the effect was paused or resumed */
    CDPREP_REASON_UNCHANGED = 4  /* for CDPREP_EVENT_STAY: neither object moved */
};

/* An effect that begins, goes on or ceases to hold for two objects: a.slot < b.slot. For self, a
 * and b are the same object. */
typedef struct cdprep_event {
    cdprep_object a, b;
    uint32_t layer_pair; /* the index when the effect began */
    /* One bit: CDPREP_ASK_COLLIDE, _OVERLAP, _WITHIN, _DISTANCE, _CONTACTS, _CONTINUOUS, _SELF,
     * _HAPTIC. */
    uint32_t effect;
    uint32_t kind;   /* CDPREP_EVENT_BEGIN, _STAY, _END */
    uint32_t reason; /* CDPREP_REASON_ */
} cdprep_event;

/* Each function stores the address of an array, and the number of its elements. The array belongs
 * to the scene. It holds the results of the last complete step, and is valid until the next one or
 * the end of the scene. Before the first step it is empty. Later versions add kinds of results as
 * new functions, and never change a result struct. */
CDPREP_API int cdprep_scene_hits(const cdprep_scene* scene, const cdprep_scene_hit** hits,
                                 size_t* count, cdprep_error* error);
CDPREP_API int cdprep_scene_overlaps(const cdprep_scene* scene,
                                     const cdprep_scene_overlap** overlaps, size_t* count,
                                     cdprep_error* error);
CDPREP_API int cdprep_scene_distances(const cdprep_scene* scene,
                                      const cdprep_scene_distance** distances, size_t* count,
                                      cdprep_error* error);
CDPREP_API int cdprep_scene_contacts(const cdprep_scene* scene,
                                     const cdprep_scene_contact** contacts, size_t* count,
                                     cdprep_error* error);
CDPREP_API int cdprep_scene_self_overlaps(const cdprep_scene* scene,
                                          const cdprep_scene_self_overlap** overlaps, size_t* count,
                                          cdprep_error* error);
CDPREP_API int cdprep_scene_impacts(const cdprep_scene* scene, const cdprep_scene_impact** impacts,
                                    size_t* count, cdprep_error* error);
CDPREP_API int cdprep_scene_bounded_distances(const cdprep_scene* scene,
                                              const cdprep_scene_bounded** distances, size_t* count,
                                              cdprep_error* error);
/* Events are in the order of hits. For the same objects, CDPREP_EVENT_END comes before _STAY, and
 * _STAY before _BEGIN. */
CDPREP_API int cdprep_scene_events(const cdprep_scene* scene, const cdprep_event** events,
                                   size_t* count, cdprep_error* error);

/* Stores a hash of these arrays, to compare runs. The hash leaves out the nearest points of
 * distances, and the triangles of distances of 0. Of bounded distances, it includes only the
 * objects, `complete` and the bounds. Of impacts, it includes only the objects and the kind. Of
 * contact lists, it includes the objects, `layer_pair`, `found`, `count` and the items. Of the
 * items, it leaves out features, `members`, and on_a and on_b of the points of manifolds. The hash
 * is equal for any number of lanes. It is also equal for any instruction set, with three
 * exceptions: bounded distances, answers with a max_error, and impacts that are CDPREP_IMPACT_NEAR.
 * All impacts also depend on the C library. So do winding numbers where the containment is
 * CDPREP_UNKNOWN. Takes O(elements) time. */
CDPREP_API int cdprep_scene_hash(const cdprep_scene* scene, uint64_t* hash, cdprep_error* error);

/* Indices into cdprep_counts.n for cdprep_scene_counts(). All but the first describe the last
 * complete step. */
enum {
    CDPREP_SCENE_OBJECTS = 0, /* objects in the scene now */
    /* Objects that moved, changed, were added, removed or moved to another layer. With
     * CDPREP_ASK_CONTINUOUS, an object also counts as moved in the step after its last motion. */
    CDPREP_SCENE_MOVED = 1,
    /* Pairs of objects whose boxes meet, and objects that are tested against themselves. */
    CDPREP_SCENE_CANDIDATES = 2,
    /* Candidates about which nothing changed: their last results are kept, and no query runs. */
    CDPREP_SCENE_KEPT = 3,
    /* Candidates whose oriented bounding boxes are apart: no query runs. */
    CDPREP_SCENE_APART = 4,
    CDPREP_SCENE_COLLIDE = 5,          /* collide queries */
    CDPREP_SCENE_WITHIN = 6,           /* within queries */
    CDPREP_SCENE_DISTANCE = 7,         /* distance queries */
    CDPREP_SCENE_OVERLAP = 8,          /* overlap queries */
    CDPREP_SCENE_TRIANGLE_PAIRS = 9,   /* in all lists of overlaps and self overlaps */
    CDPREP_SCENE_CONTACTS = 10,        /* contact queries */
    CDPREP_SCENE_LISTED_CONTACTS = 11, /* in all lists of contacts */
    CDPREP_SCENE_CONTINUOUS = 12,      /* queries for times of impact */
    CDPREP_SCENE_SELF = 13,            /* queries about single objects */
    CDPREP_SCENE_HAPTIC = 14,          /* bounded distance queries */
    /* With cdprep_scene_set_clock(): the ticks of the queries of each effect, summed over all
     * threads. */
    CDPREP_SCENE_TICKS_COLLIDE = 15,
    CDPREP_SCENE_TICKS_OVERLAP = 16,
    CDPREP_SCENE_TICKS_WITHIN = 17,
    CDPREP_SCENE_TICKS_DISTANCE = 18,
    CDPREP_SCENE_TICKS_CONTACTS = 19,
    CDPREP_SCENE_TICKS_CONTINUOUS = 20,
    CDPREP_SCENE_TICKS_SELF = 21,
    CDPREP_SCENE_TICKS_HAPTIC = 22,
    /* The ticks of the stages of a step, one after the other. They add up to the whole step,
     * excluding the time to copy results for the C API. */
    CDPREP_SCENE_TICKS_BOXES = 23,   /* of boxes, the broad phase and the reuse of results */
    CDPREP_SCENE_TICKS_QUERIES = 24, /* of all queries, from start to end */
    CDPREP_SCENE_TICKS_LISTS = 25    /* of lists and events */
};

/* Stores the work of the last complete step, for tuning. The rest of counts->n is 0. */
CDPREP_API int cdprep_scene_counts(const cdprep_scene* scene, cdprep_counts* counts,
                                   cdprep_error* error);

/* The caller's clock. It returns ticks of any length, and must be safe to call on any thread. */
typedef uint64_t (*cdprep_clock)(void);

/* Sets the clock for the ticks of cdprep_scene_counts(). With null, the initial value, no clock is
 * read, and the ticks are 0. Errors: CDPREP_WHY_BUSY. */
CDPREP_API int cdprep_scene_set_clock(cdprep_scene* scene, cdprep_clock now, cdprep_error* error);

/* --- The broad phase -------------------------------------------------------------------------- */

/* Finds the pairs of boxes that meet, as boxes move. It keeps a larger box around each box, so that
 * a small move changes no kept pair. One call at a time may use it. */
typedef struct cdprep_broad_phase cdprep_broad_phase;

typedef struct cdprep_broad_phase_options {
    cdprep_head head;
    uint32_t max_boxes; /* 0: at most 2^29 */
    uint32_t max_pairs; /* 0: pairs that meet at a time; room for twice as many is faster */
    /* 1: at most 256. An update uses at most this many lanes of its workspace. */
    uint32_t lanes;
    uint32_t reserved;                 /* 0 */
    const cdprep_allocator* allocator; /* null: the heap; copied */
} cdprep_broad_phase_options;

CDPREP_API void cdprep_broad_phase_options_init(cdprep_broad_phase_options* options, size_t size);

/* Stores the number of bytes that cdprep_broad_phase_make() needs for these options. It is about
 * 165 for each box, 24 for each pair and 4 KiB for each lane. Each lane but the first adds 4 for
 * each box. `options` may be null. On failure *size is 0. Errors: those of
 * cdprep_broad_phase_make(). CDPREP_OVER_BUDGET also means that the broad phase is larger than
 * memory can be, with pointers of 32 bits. */
CDPREP_API int cdprep_broad_phase_size(const cdprep_broad_phase_options* options, size_t* size,
                                       cdprep_error* error);

/* Makes a broad phase in the caller's memory, or in one allocation if `memory` is null and `size`
 * is 0. Memory and errors are as in cdprep_workspace_make(). An update never allocates. */
CDPREP_API int cdprep_broad_phase_make(const cdprep_broad_phase_options* options, void* memory,
                                       size_t size, cdprep_broad_phase** broad_phase,
                                       cdprep_error* error);

/* Ends a broad phase, by the rules of cdprep_workspace_end(). */
CDPREP_API void cdprep_broad_phase_end(cdprep_broad_phase* broad_phase);

/* A closed, axis-aligned box. It may be flat or a point. If lower > upper along an axis, the box is
 * absent: it forms no pair. In all other boxes, infinite numbers count as the largest finite
 * ones. */
typedef struct cdprep_world_box {
    float lower[3], upper[3];
} cdprep_world_box;

/* The boxes with which a box may form pairs. Two boxes form a pair only if each accepts a layer of
 * the other. Layers are bits. */
typedef struct cdprep_box_filter {
    uint32_t layers, accepts;
} cdprep_box_filter;

/* Two boxes that meet: a < b. Touching counts. */
typedef struct cdprep_box_pair {
    uint32_t a, b;
} cdprep_box_pair;

/* All boxes as they are now. The arrays are read only during the call. */
typedef struct cdprep_box_update {
    cdprep_head head;
    const cdprep_world_box* boxes;    /* null: with count 0 */
    const cdprep_box_filter* filters; /* null: all boxes may form pairs; or one for each box */
    /* Null: any box may have moved. Otherwise, the numbers of all boxes that may have changed, or
     * whose filters may have changed. They may be in any order, and may repeat. With these numbers,
     * an update is faster if few boxes move. `count` must then be that of the last update. */
    const uint32_t* moved;
    uint32_t count;       /* 0: of boxes, at most max_boxes */
    uint32_t moved_count; /* 0 */
} cdprep_box_update;

CDPREP_API void cdprep_box_update_init(cdprep_box_update* update, size_t size);

typedef struct cdprep_box_pairs {
    const cdprep_box_pair* items; /* sorted by a, then b; valid until the next update */
    size_t count;                 /* 0 if not complete */
    /* 0 if complete or if the call failed; otherwise the max_pairs that this update needs. */
    uint64_t needed;
    uint32_t complete; /* CDPREP_NO: there are too many pairs, or the call failed */
    uint32_t escaped;  /* boxes that left the larger box around them, or whose filter changed */
    uint32_t kept;     /* CDPREP_YES: pairs of larger boxes are kept for the next update */
    uint32_t reserved; /* 0 */
} cdprep_box_pairs;

/* Stores the pairs of boxes that meet, computed on the lanes of the workspace. They do not depend
 * on the number of lanes. Too many pairs are no error: then `complete` is CDPREP_NO. Takes O(n +
 * pairs) time if few boxes leave their larger boxes. Otherwise, it takes O(n log n + pairs) for
 * boxes of similar size that are spread out.
 * Errors: CDPREP_WHY_NOT_FINITE for a box with NaN; CDPREP_WHY_OUT_OF_RANGE for counts and numbers
 * of boxes; CDPREP_WHY_BUSY. An update that fails changes nothing in the broad phase. */
CDPREP_API int cdprep_broad_phase_update(cdprep_broad_phase* broad_phase,
                                         const cdprep_box_update* update,
                                         cdprep_workspace* workspace, cdprep_box_pairs* pairs,
                                         cdprep_error* error);

/* --- Scenes with a broad phase of the caller -------------------------------------------------- */

/* The requirements of a plan for the objects of one layer. */
typedef struct cdprep_layer_info {
    uint32_t ask; /* as cdprep_plan_ask() stores it */
    /* The filter for boxes of its objects: this layer, and the layers with which it is paired. A
     * pair counts only if it has an effect between two objects: not only CDPREP_ASK_SELF, _DEFORM
     * or _TEAR. */
    cdprep_box_filter filter;
    uint32_t reserved; /* 0 */
    double reach;      /* the margin around boxes of its objects, model units */
} cdprep_layer_info;

/* Stores what a plan requires of the objects of a layer. Takes O(layer pairs) time. On
 * failure, *info is all 0.
 * Errors: CDPREP_WHY_OUT_OF_RANGE for a layer that does not exist. */
CDPREP_API int cdprep_plan_layer(const cdprep_plan* plan, uint32_t layer, cdprep_layer_info* info,
                                 cdprep_error* error);

/* Stores an axis-aligned box around a model that `world_from_model` moves. First, the model's own
 * box is enlarged by `reach` on all sides, in model units. Then the pose moves this box, and the
 * result is the box around it. It contains every vertex as the pose moves it, and all points within
 * `reach` of them. It is absent if the model has no triangles. The box is relative to the point
 * `origin`, 3 numbers. A null `origin` means the point 0 0 0. All boxes of a broad phase must have
 * the same origin. Limits beyond the largest float are rounded outwards: an upper limit becomes
 * infinite. Far from the origin, rounding to float widens the box: at 10^7 by about a unit on each
 * side. If two models are at most d apart, their boxes with a reach of d / 2 each meet. Takes some
 * 100 ns. On failure the box is absent.
 * Errors: CDPREP_WHY_NOT_RIGID; CDPREP_WHY_NOT_FINITE and CDPREP_WHY_OUT_OF_RANGE for numbers.
 * CDPREP_WHY_NOT_BAKED or _NOT_OPENED for a model without a BVH (section bvh_nodes). */
CDPREP_API int cdprep_model_box(const cdprep_model* model, const cdprep_pose* world_from_model,
                                double reach, const double* origin, cdprep_world_box* around,
                                cdprep_error* error);

/* Stores the address of an array of boxes and the number of its elements, which is max_objects. Box
 * i is the box of slot i in the next step, relative to the plan's origin. It contains the object as
 * it is now, enlarged by the `reach` of its layer (cdprep_plan_layer()). With
 * CDPREP_ASK_CONTINUOUS, it contains the whole motion since the last step. Free slots have absent
 * boxes, and so do objects of a layer without effects between two objects. The array belongs to the
 * scene, and is valid until the scene changes. Takes O(changed objects) time, or O(max_objects) if
 * the plan has CDPREP_ASK_DEFORM or _TEAR.
 * Errors: CDPREP_WHY_BUSY. */
CDPREP_API int cdprep_scene_boxes(cdprep_scene* scene, const cdprep_world_box** boxes,
                                  size_t* count, cdprep_error* error);

/* Does the same as cdprep_scene_step(), but with the pairs that the caller's own broad phase found.
 * The candidates are pairs of slots, sorted by a, then b, as cdprep_broad_phase_update() stores
 * them. In each pair, a < b, and no pair occurs twice. They must contain every pair whose layers
 * are paired and whose boxes meet: the scene does not find missing pairs. Pairs whose boxes do not
 * meet, or whose layers are not paired, are ignored. Takes O(max_objects + candidates + pairs log
 * pairs) time, plus the time of the queries.
 * Errors, which name the argument, such as `candidates[3]`. After an error nothing has changed, and
 * `complete` is CDPREP_NO:
 * - CDPREP_WHY_OUT_OF_RANGE: a slot is not below max_objects, or a >= b, or the pair does not come
 *   after the previous one.
 * - CDPREP_WHY_STALE: a slot has no object. CDPREP_WHY_BUSY. */
CDPREP_API int cdprep_scene_step_with(cdprep_scene* scene, const cdprep_box_pair* candidates,
                                      size_t count, cdprep_workspace* workspace, cdprep_step* step,
                                      cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_SCENE_H */
