/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_BUILD_H
#define CDPREP_C_BUILD_H

#include "cdprep/c/model.h"

/* Models of meshes that a program has in memory: no file, no `cdprep bake`. */

/* How a model keeps positions. */
enum {
    CDPREP_AS_GIVEN = 0, /* doubles as doubles, floats as floats */
    CDPREP_SINGLE = 1    /* doubles are rounded to the nearest floats, half as large */
};

/* A mesh, and what to build of it. The arrays are read during the call alone.
 *
 * Triangles share a vertex where they have its number: equal positions are not merged, and a
 * surface with such a seam is not closed. Vertices that no triangle uses are left out. Triangles
 * may be degenerate or equal. Answers have the numbers of these arrays. */
typedef struct cdprep_build_options {
    cdprep_head head;
    uint32_t ask;               /* 0: all that a build can serve; else these bits alone */
    uint32_t precision;         /* CDPREP_AS_GIVEN */
    const double* positions;    /* null: 3 numbers a vertex, model units */
    const float* positions_f32; /* null: the same as floats; one of the two is set */
    const uint32_t* triangles;  /* null: 3 vertices a triangle, counter-clockwise from outside */
    size_t vertex_count;        /* 0: of a mesh without vertices both positions may be null */
    size_t triangle_count;      /* 0: of a mesh without triangles `triangles` may be null */
    const cdprep_allocator* allocator; /* null: malloc(); copied */
} cdprep_build_options;

/* Makes default options: an empty mesh. Writes `size` bytes, which is
 * sizeof(cdprep_build_options). Null does nothing. */
CDPREP_API void cdprep_build_options_init(cdprep_build_options* options, size_t size);

/* Stores a number of bytes that is enough for cdprep_model_build() with these options. It follows
 * from the counts, `ask`, `precision` and the kind of positions; no array is read. It allows for
 * the worst mesh with these counts. One that is closed and connected takes about a seventh less.
 * On failure *size is 0.
 * Errors: those of cdprep_model_build() that need no look at the arrays. */
CDPREP_API int cdprep_model_build_size(const cdprep_build_options* options, size_t* size,
                                       cdprep_error* error);

/* Builds a model, which answers every question that it serves exactly as a bake of the same
 * arrays. A build can serve CDPREP_ASK_COLLIDE, _OVERLAP, _DISTANCE, _WITHIN, _INSIDE, _RAY,
 * _CLOSEST, _TOUCH, _CORNERS and _SOLID; all other questions are refused with
 * CDPREP_WHY_NOT_BAKED. cdprep_model_close() closes it. On failure *model is null.
 *
 * `memory` starts at a multiple of CDPREP_ALIGNMENT and has at least cdprep_model_build_size()
 * bytes. The model lives there: the caller leaves it alone until cdprep_model_close(), and then it
 * is free for anything. After a failure it may hold anything. Null memory of size 0: one
 * allocation by the allocator, of what this mesh takes; a closed one about 85 bytes a triangle.
 * Beside it malloc() gives about 1 KiB until cdprep_model_close(), and about 120 bytes a triangle
 * during the call.
 *
 * The lanes of `workspace` share the work; the model is the same, byte for byte, on any number of
 * lanes and in any floating-point environment. O(n log n) in the triangles.
 *
 * Numbers that are wrong are named by vertex and by triangle: `options.positions[7]` is vertex 7,
 * `options.triangles[12]` is triangle 12. Memory is checked after them, and the workspace last.
 * Errors: CDPREP_WHY_NULL for positions or triangles that are missing; CDPREP_WHY_NO_MEANING
 * where both positions are set, and for an allocator beside memory; CDPREP_WHY_NOT_BAKED where
 * `ask` wants what no build serves, with the `bake` option for it; CDPREP_WHY_NOT_FINITE;
 * CDPREP_WHY_OUT_OF_RANGE for more than 2^31 - 1 vertices or triangles, a position beyond 2^1000
 * (beyond the floats with CDPREP_SINGLE), a vertex that is not there and the alignment;
 * CDPREP_WHY_TOO_SMALL; CDPREP_WHY_BUSY; CDPREP_OVER_BUDGET. */
CDPREP_API int cdprep_model_build(const cdprep_build_options* options, void* memory, size_t size,
                                  cdprep_workspace* workspace, cdprep_model** model,
                                  cdprep_error* error);

#endif /* CDPREP_C_BUILD_H */
