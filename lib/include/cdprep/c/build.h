/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_BUILD_H
#define CDPREP_C_BUILD_H

#include "cdprep/c/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Models built from meshes in memory, without a file and without `cdprep bake`. */

/* The precision in which a model keeps positions. */
enum {
    CDPREP_AS_GIVEN = 0, /* doubles as doubles, floats as floats */
    CDPREP_SINGLE = 1 /* doubles are rounded to the nearest floats; positions are half as large */
};

/* A mesh, and what to build from it. The arrays are read only during the call.
 *
 * Triangles share a vertex only if they name the same vertex number. Vertices with equal positions
 * are not merged, and a surface with such a seam is not balanced. Vertices that no triangle uses
 * are left out. Triangles may be degenerate or equal. Answers number triangles and vertices as in
 * these arrays. */
typedef struct cdprep_build_options {
    cdprep_head head;
    uint32_t ask;       /* 0: all that a build can serve; otherwise these CDPREP_ASK_ bits */
    uint32_t precision; /* CDPREP_AS_GIVEN */
    /* Null; otherwise 3 numbers per vertex, model units. */
    const double* positions;
    /* Null; otherwise these numbers as floats. Set only one of the two arrays. */
    const float* positions_f32;
    /* Null; otherwise 3 vertices per triangle, counter-clockwise from outside. */
    const uint32_t* triangles;
    size_t vertex_count;               /* 0: a mesh without vertices needs no positions */
    size_t triangle_count;             /* 0: a mesh without triangles needs no `triangles` */
    const cdprep_allocator* allocator; /* null: the heap; copied */
} cdprep_build_options;

/* Makes default options: an empty mesh. Writes `size` bytes, which must be
 * sizeof(cdprep_build_options). Null does nothing. */
CDPREP_API void cdprep_build_options_init(cdprep_build_options* options, size_t size);

/* Stores a number of bytes that is enough for cdprep_model_build() with these options. It depends
 * on the counts, `ask`, `precision` and the type of the positions; no array is read. It covers the
 * worst mesh with these counts. A closed and connected mesh takes about a seventh less. On failure
 * *size is 0.
 * Errors: those of cdprep_model_build() for `options`, except for the contents of the arrays. */
CDPREP_API int cdprep_model_build_size(const cdprep_build_options* options, size_t* size,
                                       cdprep_error* error);

/* Builds a model. Its answers are those of a bake of the same arrays. Exception: a bake also merges
 * vertices with equal positions. A build can serve CDPREP_ASK_COLLIDE, _OVERLAP, _DISTANCE,
 * _WITHIN, _CONTINUOUS, _SELF, _DEFORM, _TEAR, _HAPTIC, _INSIDE, _RAY, _CLOSEST, _TOUCH, _CORNERS
 * and _SOLID. All other queries are refused with CDPREP_WHY_NOT_BAKED. Close the model with
 * cdprep_model_close(). On failure *model is null.
 *
 * `memory` must start at a multiple of CDPREP_ALIGNMENT and have at least cdprep_model_build_size()
 * bytes. The model lives there: do not touch this memory before cdprep_model_close(). Afterwards it
 * is free for any use. After a failure it may hold anything. With null memory of size 0, the
 * allocator makes one allocation of the size that this mesh takes. A closed mesh takes about 85
 * bytes per triangle. In addition, the model takes about 1 KiB of the heap until
 * cdprep_model_close(). While it runs, the call also takes about 120 bytes of the heap per
 * triangle.
 *
 * The lanes of `workspace` share the work. The model is the same, byte for byte, on any number of
 * lanes and in any floating-point environment. Takes O(n log n) time for n triangles.
 *
 * error.argument names an invalid number by its vertex or triangle: `options.positions[7]` is
 * vertex 7, `options.triangles[12]` is triangle 12. Null `options`, `workspace` and `model` are
 * reported first. `memory` is checked after the arrays, and whether the workspace is in use last.
 * Errors:
 * - CDPREP_WHY_NULL: `options`, `workspace`, `model`, positions or triangles are missing. Or the
 *   allocator lacks a function, or `memory` is null and `size` is not 0.
 * - CDPREP_WHY_NO_MEANING: both arrays of positions are set, or an allocator is set in addition to
 *   memory.
 * - CDPREP_WHY_NOT_BAKED: a build cannot serve options.ask; the message names the `bake` option
 *   for it.
 * - CDPREP_WHY_NOT_FINITE: a position is NaN or infinite.
 * - CDPREP_WHY_OUT_OF_RANGE, in five cases: `ask` or `precision` has an unknown value. There are
 *   more than 2^31 - 1 vertices or triangles, or more than memory holds. A position is beyond
 *   2^1000 or, with CDPREP_SINGLE, beyond the largest float. A triangle names a vertex that does
 *   not exist. `memory` or the allocator's memory is not aligned.
 * - CDPREP_WHY_TOO_SMALL: `size` is less than the size from cdprep_model_build_size().
 * - CDPREP_WHY_BUSY: another call uses the workspace.
 * - CDPREP_OVER_BUDGET: there is not enough memory. */
CDPREP_API int cdprep_model_build(const cdprep_build_options* options, void* memory, size_t size,
                                  cdprep_workspace* workspace, cdprep_model** model,
                                  cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_BUILD_H */
