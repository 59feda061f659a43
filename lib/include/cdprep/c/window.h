/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_WINDOW_H
#define CDPREP_C_WINDOW_H

#include "cdprep/c/pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A window is a copy of the part of a large model near a small one. It serves loops that must
 * answer in time. A slow loop fills one window while a fast loop queries another; then the loops
 * swap the two windows. */

/* A window. It is queried through cdprep_window_model(). While one call fills it, other calls of
 * this header that use it fail with CDPREP_WHY_BUSY. During a fill, no query about its model may
 * run: this is not checked. */
typedef struct cdprep_window cdprep_window;

typedef struct cdprep_window_options {
    cdprep_head head;
    /* 0, which is refused: the maximum number of BVH leaves, which have up to 8 triangles each. */
    uint32_t max_leaves;
    uint32_t reserved;                 /* 0 */
    const cdprep_allocator* allocator; /* null: the heap; copied */
} cdprep_window_options;

/* Makes default options. Writes `size` bytes, which must be sizeof(cdprep_window_options). */
CDPREP_API void cdprep_window_options_init(cdprep_window_options* options, size_t size);

/* Stores the number of bytes that cdprep_window_make() needs for these options: about 1,100 for
 * each leaf. On failure *size is 0. Errors: those of cdprep_window_make(). */
CDPREP_API int cdprep_window_size(const cdprep_window_options* options, size_t* size,
                                  cdprep_error* error);

/* Makes an empty window. On failure *window is null. End it with cdprep_window_end().
 *
 * `memory` must start at a multiple of CDPREP_ALIGNMENT and have at least cdprep_window_size()
 * bytes. If `memory` is null and `size` is 0, the allocator makes one allocation of
 * cdprep_window_size() bytes. In addition, the window takes about 1 KiB of the heap. No later call
 * but cdprep_window_end() allocates or frees memory, except to report an error.
 *
 * Errors:
 * - CDPREP_WHY_NULL: no options.
 * - CDPREP_WHY_OUT_OF_RANGE: max_leaves is 0 or too large, or `memory` is not aligned.
 * - CDPREP_WHY_NO_MEANING: an allocator is set in addition to memory.
 * - CDPREP_WHY_TOO_SMALL: `size` is less than the size from cdprep_window_size().
 * - CDPREP_OVER_BUDGET: there is not enough memory. */
CDPREP_API int cdprep_window_make(const cdprep_window_options* options, void* memory, size_t size,
                                  cdprep_window** window, cdprep_error* error);

/* Ends a window. Does nothing for null, or while another call fills the window. */
CDPREP_API void cdprep_window_end(cdprep_window* window);

/* Returns the model to query, or null if `window` is null. It is the same object after each fill,
 * and lives as long as the window: do not close it. It serves CDPREP_ASK_COLLIDE, _OVERLAP,
 * _DISTANCE, _WITHIN, _RAY, _CLOSEST and _TOUCH. Its triangles have the numbers of the large model.
 * The probe is the small model of the last fill. A query is complete if nothing farther than
 * cdprep_window_margin() from the probe can change its answer. */
CDPREP_API const cdprep_model* cdprep_window_model(const cdprep_window* window);

typedef struct cdprep_window_info {
    double radius;     /* everything at most this far from the probe is in the window */
    uint32_t leaves;   /* in the window */
    uint32_t is_empty; /* CDPREP_YES: even what touches the probe did not fit; radius is 0 */
} cdprep_window_info;

/* Fills a window with the leaves of pair.a that may be at most `radius` from pair.b, the probe. If
 * they do not fit, info->radius is less than `radius`, or info->is_empty is CDPREP_YES. `radius`
 * must be at least 0. Infinity asks for all leaves; if they fit, info->radius is 2^1000. Of `pair`,
 * uses only the models and their placement.
 * Takes O(log n + leaves log m) time for n triangles of A and m of B.
 * On failure, the window is as before, and *info is all 0. Errors: those of cdprep_distance().
 * CDPREP_WHY_OUT_OF_RANGE: pair.a or pair.b is the model of this window. CDPREP_WHY_BUSY.
 * Needs: CDPREP_ASK_DISTANCE */
CDPREP_API int cdprep_window_fill(cdprep_window* window, const cdprep_pair* pair, double radius,
                                  cdprep_window_info* info, cdprep_error* error);

/* Stores the distance from pair.b within which a window has everything of the large model. pair.a
 * is the window's model. The margin is the radius, minus the largest displacement of a point of the
 * probe since the fill, minus rounding. The displacement is relative to the large model. The margin
 * is negative if the probe has moved too far. It is -2^1000 if pair.b is not the probe of the last
 * fill, or has deformed since. It is also -2^1000 if that fill stored CDPREP_YES in is_empty. It is
 * 2^1000 if nothing can be missing. Takes O(1) time.
 * Errors: those of cdprep_distance(). CDPREP_WHY_OUT_OF_RANGE: pair.a is not the model of a window.
 * CDPREP_WHY_BUSY: the window is being filled.
 * Needs: CDPREP_ASK_DISTANCE */
CDPREP_API int cdprep_window_margin(const cdprep_pair* pair, double* margin, cdprep_error* error);

/* Stores the distance of pair.b from the large model in the shape that this model had at the fill.
 * pair.a is the window's model. Works like cdprep_distance_bounded(). But the answer is complete
 * only if the distance or max_distance is less than the margin, or triangles touch. A complete
 * answer is that of the large model, but may name another pair of triangles that touch. If the
 * answer is not complete, `lower` is at most the margin, or 0 if the margin is negative.
 * Errors: those of cdprep_distance_bounded() and cdprep_window_margin().
 * Needs: CDPREP_ASK_DISTANCE */
CDPREP_API int cdprep_window_distance(const cdprep_pair* pair,
                                      const cdprep_distance_options* options, uint64_t work,
                                      cdprep_workspace* workspace, cdprep_bounded* bounded,
                                      cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_WINDOW_H */
