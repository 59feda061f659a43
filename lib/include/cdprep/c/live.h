/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_LIVE_H
#define CDPREP_C_LIVE_H

#include "cdprep/c/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Models whose vertices move and whose triangles come and go: objects that deform and tear. */

/* A live model. It is queried through cdprep_live_model(). While one call changes it, other calls
 * of this header that use it fail with CDPREP_WHY_BUSY. During a change, no query about its model
 * may run: this is not checked. A scene finds changes of an object's model if pairs of the object's
 * layer have CDPREP_ASK_DEFORM or _TEAR. Otherwise, after a change, set the pose of each object
 * that uses the model. */
typedef struct cdprep_live cdprep_live;

typedef struct cdprep_live_options {
    cdprep_head head;
    const cdprep_model* model; /* null, which is refused: the base, baked or built; unused later */
    uint32_t max_triangles;    /* 0: no triangles are added or removed; else the maximum */
    uint32_t max_vertices;     /* 0: as in the base; triangles may use vertex numbers below this */
    const cdprep_allocator* allocator; /* null: the heap; copied */
} cdprep_live_options;

/* Makes default options. Writes `size` bytes, which must be sizeof(cdprep_live_options). */
CDPREP_API void cdprep_live_options_init(cdprep_live_options* options, size_t size);

/* Stores the number of bytes that cdprep_live_make() needs for these options. On failure *size is
 * 0. Without max_triangles, it is about 100 for each triangle. With max_triangles, it is 125 to 150
 * for each triangle of this limit. In both cases, up to 140 KB are added. These numbers are for one
 * vertex per two triangles. Takes as long as cdprep_live_make(), and as much memory while it runs.
 * Errors: those of cdprep_live_make(). */
CDPREP_API int cdprep_live_size(const cdprep_live_options* options, size_t* size,
                                cdprep_error* error);

/* Makes a live model. On failure *live is null. End it with cdprep_live_end().
 *
 * `memory` must start at a multiple of CDPREP_ALIGNMENT and have at least cdprep_live_size() bytes.
 * If `memory` is null and `size` is 0, the allocator makes one allocation of cdprep_live_size()
 * bytes. In addition, the model takes about 1 KiB of the heap. Takes O(n) time, and O(n log n) with
 * max_triangles. No later call but cdprep_live_end() and cdprep_live_image() allocates or frees
 * memory, except to report an error. Triangles are spread over the memory for max_triangles. A
 * limit far above the number in use therefore makes queries slower.
 *
 * Errors:
 * - CDPREP_WHY_NULL: no base.
 * - CDPREP_WHY_NOT_BAKED, CDPREP_WHY_NOT_OPENED: the base does not serve CDPREP_ASK_OVERLAP and
 *   CDPREP_ASK_CORNERS.
 * - CDPREP_WHY_OUT_OF_RANGE: max_triangles, max_vertices or the base is too large, or a limit is
 *   less than the base has.
 * - CDPREP_WHY_OUT_OF_RANGE: the base has vertices that a repair made, or equal numbers for two
 *   vertices or two triangles.
 * - CDPREP_WHY_OUT_OF_RANGE: the base is the model of a live model made with max_triangles.
 * - CDPREP_WHY_OUT_OF_RANGE: `memory` is not aligned.
 * - CDPREP_WHY_NO_MEANING: max_vertices without max_triangles, or an allocator in addition to
 *   memory.
 * - CDPREP_WHY_TOO_SMALL: `size` is less than the size from cdprep_live_size().
 * - CDPREP_OVER_BUDGET: there is not enough memory. */
CDPREP_API int cdprep_live_make(const cdprep_live_options* options, void* memory, size_t size,
                                cdprep_live** live, cdprep_error* error);

/* Ends a live model. Does nothing for null, or while another call changes the live model. */
CDPREP_API void cdprep_live_end(cdprep_live* live);

/* Returns the model to query, or null if `live` is null. It is the same object after each change,
 * and lives as long as the live model: do not close it. It serves CDPREP_ASK_COLLIDE, _OVERLAP,
 * _DISTANCE, _WITHIN, _CONTINUOUS, _SELF, _DEFORM, _TEAR, _HAPTIC, _INSIDE, _RAY, _CLOSEST, _TOUCH
 * and _CORNERS. It also serves CDPREP_ASK_SOLID if the base does.
 *
 * Once a triangle was added or removed, the model counts as unbalanced and has no components.
 * Queries about solids then store CDPREP_UNKNOWN, unless boxes or surfaces decide. All numbers of
 * triangles are less than cdprep_live_info.number_bound. cdprep_marks needs that many bits for this
 * model. */
CDPREP_API const cdprep_model* cdprep_live_model(const cdprep_live* live);

/* New positions of vertices. */
typedef struct cdprep_live_move {
    cdprep_head head;
    const uint32_t* vertices;   /* null: all, in order; otherwise the numbers of those to move */
    const double* positions;    /* null: 3 numbers per vertex, model units */
    const float* positions_f32; /* null: the same as floats; set one of the two */
    size_t count;               /* 0: the number of positions */
} cdprep_live_move;

CDPREP_API void cdprep_live_move_init(cdprep_live_move* moved, size_t size);

/* Moves vertices, which are numbered as in the mesh from which the base was made. Without
 * moved.vertices, moves all vertices. Then moved.count must be at least cdprep_live_info.vertices.
 * After the move, query results are those of a model built from the new positions. The lanes of the
 * workspace share the work; results do not depend on their number. If a vertex is listed twice, the
 * last position counts. A pair cache of the model stays valid.
 *
 * With max_triangles, a vertex that no triangle uses may get its first position. Takes O(n) time
 * without moved.vertices. With it, takes O(m log n) time for m triangles at these vertices, and
 * reads one bit per leaf. In three cases, it takes O(n) time:
 * - A vertex of a triangle leaves the cube of the frame. When chosen, this cube was two to four
 *   times the model's size.
 * - The model has become much smaller than this cube.
 * - The first coordinate that is not a float appears, or the last one disappears.
 *
 * On failure, nothing changes. Errors:
 * - CDPREP_WHY_NULL: no positions.
 * - CDPREP_WHY_NO_MEANING: both arrays of positions are set.
 * - CDPREP_WHY_NOT_FINITE: a position is NaN or infinite. error.argument names it:
 *   `moved.positions[7]` is the eighth position.
 * - CDPREP_WHY_OUT_OF_RANGE, in six cases: moved.count exceeds 2^31 - 1. There are too few
 *   positions for all vertices. A vertex does not exist. A position is beyond 2^1000. Positions are
 *   doubles and the model stores floats. `moved` points into the model.
 * - CDPREP_WHY_BUSY: another call changes the live model or uses the workspace. */
CDPREP_API int cdprep_live_refit(cdprep_live* live, const cdprep_live_move* moved,
                                 cdprep_workspace* workspace, cdprep_error* error);

/* Adds `count` triangles: 3 vertices each, numbered as in cdprep_live_refit(). *first is the number
 * of the first triangle; the others get the next numbers. Answers name a triangle by its number,
 * which no other triangle gets later. Takes O(m log n) time for m triangles, and reads one bit per
 * leaf. In addition, full subtrees are redistributed: each at most once, and at most 4,096
 * triangles at a time. Takes O(n) more if a vertex lies outside the frame of cdprep_live_refit().
 *
 * On failure, nothing changes and *first is CDPREP_NONE. Errors:
 * - CDPREP_WHY_NO_MEANING: the live model was made without max_triangles.
 * - CDPREP_WHY_OUT_OF_RANGE, in four cases: There would be more triangles than max_triangles. A
 *   vertex does not exist or has no position; the message names it and its triangle. Numbers would
 *   reach 2^31 - 1. `triangles` points into the model.
 * - CDPREP_WHY_BUSY: another call changes the live model. */
CDPREP_API int cdprep_live_append(cdprep_live* live, const uint32_t* triangles, size_t count,
                                  uint32_t* first, cdprep_error* error);

/* Removes `count` triangles by their numbers. A number that is listed twice counts once. Takes
 * O(m log n) time for m numbers, and reads one bit per leaf.
 *
 * On failure, nothing changes. Errors:
 * - CDPREP_WHY_NO_MEANING: the live model was made without max_triangles.
 * - CDPREP_WHY_STALE: a triangle was removed before, or was never added. error.argument names it:
 *   `numbers[5]` is the sixth.
 * - CDPREP_WHY_BUSY: another call changes the live model. */
CDPREP_API int cdprep_live_remove(cdprep_live* live, const uint32_t* numbers, size_t count,
                                  cdprep_error* error);

/* Rebuilds subtrees of the BVH whose boxes have grown, so that queries stay fast. Rebuilds at most
 * `most_triangles` triangles, in whole subtrees of up to 4,096. *taken is the number of triangles
 * rebuilt. Answers stay the same, but caches start anew. A sweep can be queried only after a later
 * cdprep_sweep_finish_step(). See LiveModel::rebuild() in cdprep/live_model.h. Takes O(nodes) time,
 * and about 100 ns for each triangle rebuilt.
 * Errors: CDPREP_WHY_BUSY: another call changes the live model. */
CDPREP_API int cdprep_live_rebuild(cdprep_live* live, uint32_t most_triangles, uint32_t* taken,
                                   cdprep_error* error);

typedef struct cdprep_live_info {
    uint32_t triangles;    /* now */
    uint32_t number_bound; /* all numbers of triangles are less than this */
    uint32_t vertices;     /* all numbers of vertices with a position are less than this */
    uint32_t is_torn;      /* CDPREP_YES once a triangle was added or removed; else CDPREP_NO */
    double surface_cost;   /* of the BVH: lower is better; compare it with the value at the start */
    uint64_t reserved[4];  /* 0 */
} cdprep_live_info;

/* Stores facts about a live model. Takes O(n) time. */
CDPREP_API int cdprep_live_describe(const cdprep_live* live, cdprep_live_info* info,
                                    cdprep_error* error);

/* A triangle of a live model with max_triangles. */
typedef struct cdprep_live_triangle {
    uint32_t number;    /* the number that answers use */
    uint32_t vertex[3]; /* numbers as in cdprep_live_refit() */
} cdprep_live_triangle;

typedef struct cdprep_live_triangle_list {
    cdprep_live_triangle* items; /* null with room 0: only counts */
    size_t room;                 /* input */
    size_t count;                /* output: the number of all triangles, also beyond the room */
} cdprep_live_triangle_list;

/* Lists the triangles in ascending order of their numbers. If there is too little room, the list
 * keeps the smallest numbers. Takes O(n log n) time.
 * Errors: CDPREP_WHY_NO_MEANING: the live model was made without max_triangles, so its triangles
 * are those of its base. CDPREP_WHY_BUSY: another call changes the live model. */
CDPREP_API int cdprep_live_triangles(const cdprep_live* live, cdprep_live_triangle_list* list,
                                     cdprep_error* error);

/* Stores the address of the bytes of a live model as it is now, to save or to send. The stride is
 * 1, and the count is the number of bytes. cdprep_model_open_memory() accepts a copy of them. The
 * address stays valid while the live model exists. The bytes stay valid until its next change. They
 * depend only on the base, the positions and the order that cdprep_live_rebuild() made. Takes
 * O(bytes) time. Allocates. The call writes to the model, so no query may use the model during the
 * call. Caches, sweeps and windows treat the call as a change of the model. So they ignore gaps
 * proven before, and a sweep needs a new step.
 * On failure, image->data is null. Errors:
 * - CDPREP_WHY_NO_MEANING: the live model was made with max_triangles. Build a model of
 *   cdprep_live_triangles() instead.
 * - CDPREP_WHY_BUSY: another call changes the live model.
 * - CDPREP_OVER_BUDGET: there is not enough memory. */
CDPREP_API int cdprep_live_image(cdprep_live* live, cdprep_array* image, cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_LIVE_H */
