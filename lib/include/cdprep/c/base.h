/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_BASE_H
#define CDPREP_C_BASE_H

#include <stddef.h>
#include <stdint.h>

#include "cdprep/format/api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The common parts of the C API: codes, errors, memory, workspaces, poses.
 *
 * Rules that hold for every function:
 *
 * - Arguments come in this order: the object of the call, other inputs, the workspace, a visitor
 *   and its context, the answer, the error.
 * - The return value is a code. `error` may be null; otherwise it is always filled. On success,
 *   code and why are 0 and both texts are empty.
 * - A struct that starts with cdprep_head is an input that may grow in later versions. Only its
 *   _init() function makes it valid: that function writes size, tag and defaults. A struct that
 *   its _init() did not make, even one of zeros, is refused with CDPREP_WHY_NOT_INITIALISED. The
 *   comment of a field starts with its default. For a parameter named `options`, null gives the
 *   defaults. Exceptions: builds, plans, live models and windows require options.
 * - Arguments are checked before anything is computed. The struct of a query is checked in this
 *   order: size and tag; required pointers; enumerators; numbers; poses; fields without meaning for
 *   the query. The next checks are whether the model serves the query, and whether the workspace is
 *   in use. If there are several errors, only one is reported. One invalid entry makes the whole
 *   batch fail.
 * - Numbers are finite and at most 2^1000 in magnitude. NaN is always refused. Infinity is allowed
 *   only for max_t, the limits of boxes, the radius of a window, and max_distance of a query. No
 *   answer holds NaN. An answer may hold infinity only if its comment says so.
 * - On failure, answers are unknown: counts and `found` are 0; `hit`, `inside` and similar fields
 *   are CDPREP_UNKNOWN. The items of lists may hold anything. Answers stay unchanged if the call
 *   cannot know their number. This happens if the query is null or not initialised, or if a count
 *   is too large for memory. They also stay unchanged if cdprep_pose_move() or
 *   cdprep_model_corners() fails.
 * - Lengths are in model units. Limits are inclusive. Triangles and vertices are numbered as in
 *   the imported file, or as in the arrays of a build.
 * - A list stores at most `room` answers; `count` is the number of all answers. Too little room is
 *   not an error: as many as fit are stored. A list without room only counts. Exception:
 *   cdprep_contact_list counts at most cdprep_contact_options.most.
 * - No query allocates, except for the message of an error. Opening or building a model, compiling
 *   a plan, and the _make() functions allocate.
 * - Models are read-only and serve any number of threads. Exception: the model of a live model or a
 *   window must not be used while it changes. A workspace serves one call at a time, and so does a
 *   broad phase. At any time, a scene serves one call that changes it, or any number of calls that
 *   only read it. Two calls share nothing else, unless the caller passes the same object to both,
 *   such as a cache. There is no global state.
 * - Callbacks must return: they must not throw or call longjmp(). A visitor may run queries with
 *   another workspace. A visitor runs in the caller's floating-point environment. Answers do not
 *   depend on that environment.
 * - Null is refused, except where a comment allows it. An invalid pointer, such as one to a closed
 *   model, can crash a call. So can a damaged file with CDPREP_MAP_TRUSTED, and a mapped file that
 *   is truncated while open. */

#define CDPREP_VERSION_MAJOR 0
#define CDPREP_VERSION_MINOR 1
#define CDPREP_VERSION_PATCH 0
#define CDPREP_ALIGNMENT 64    /* in bytes, of memory for _make(), _build() and _open_memory() */
#define CDPREP_NONE UINT32_MAX /* stored instead of a number: no triangle, vertex, face ... */

/* The first member of every input struct that may grow. Only _init() functions write it. */
typedef struct cdprep_head {
    uint32_t size; /* of the struct, in bytes, as compiled into the caller */
    uint32_t tag;  /* one value for each type of struct */
} cdprep_head;

/* Codes, equal to the exit codes of the program cdprep. No function returns 1 or 4. Numbers are
 * never reused. */
enum {
    CDPREP_OK = 0,
    CDPREP_BAD_ARGUMENT = 2, /* an invalid argument; error.why is its kind */
    CDPREP_UNREADABLE = 3,   /* a file that is missing, malformed or damaged */
    CDPREP_OVER_BUDGET = 5,  /* not enough memory */
    CDPREP_INTERNAL = 6      /* an internal error of this library */
};

/* Kinds of invalid arguments. Numbers are never reused. */
enum {
    CDPREP_WHY_NULL = 1,            /* a null pointer where null is not allowed */
    CDPREP_WHY_NOT_INITIALISED = 2, /* a struct that its _init() did not make */
    CDPREP_WHY_NEWER_FIELD = 3,     /* a reserved field, or one of a newer version, is not 0 */
    CDPREP_WHY_OUT_OF_RANGE = 4,    /* an enumerator, a number or an index */
    CDPREP_WHY_NOT_FINITE = 5,      /* NaN, or infinity where it is not allowed */
    CDPREP_WHY_NOT_RIGID = 6,       /* a pose that scales, shears or mirrors */
    CDPREP_WHY_NO_MEANING = 7,      /* a field or an argument that this call cannot use */
    CDPREP_WHY_NOT_BAKED = 8,       /* the model lacks what the query needs */
    CDPREP_WHY_NOT_OPENED = 9,      /* the file has what the query needs, but it was not opened */
    CDPREP_WHY_TOO_SMALL = 10,      /* memory, or an array of cdprep_marks */
    CDPREP_WHY_STALE = 11,          /* an item that is gone, never existed or has since changed */
    CDPREP_WHY_BUSY = 12            /* a workspace, scene or broad phase in use by another call */
};

typedef struct cdprep_error {
    int32_t code;
    int32_t why;       /* CDPREP_WHY_... if the code is CDPREP_BAD_ARGUMENT; otherwise 0 */
    char argument[56]; /* the invalid argument, such as "pairs[3].pose_b"; ends with a zero */
    char message[448]; /* a whole sentence for a person, cut to fit; ends with a zero */
} cdprep_error;

/* An answer that may be unknown. Compare it with one of these: in a plain `if`, unknown counts as
 * yes. */
enum { CDPREP_NO = 0, CDPREP_YES = 1, CDPREP_UNKNOWN = 2 };

typedef struct cdprep_version {
    uint32_t major, minor, patch;          /* of the library in use, not of this header */
    uint32_t abi;                          /* equal for binary-compatible versions of the library */
    uint32_t oldest_format, newest_format; /* the range of file versions that the library reads */
    char kernels[16];                      /* the instruction set in use: "avx2", "scalar", ... */
} cdprep_version;

/* Stores the version of the library in use. Null does nothing. */
CDPREP_API void cdprep_version_get(cdprep_version* version);

/* Returns the name of a code, such as "CDPREP_UNREADABLE". Never returns null: for any other
 * number, it returns "CDPREP_UNKNOWN_CODE". */
CDPREP_API const char* cdprep_code_name(int code);

/* The caller's memory functions. `allocate` returns null if there is no memory. `size` is not 0,
 * and `alignment` is a power of two of at most CDPREP_ALIGNMENT. `release` receives the same size.
 * The calling thread calls both functions, and only while it makes or ends an object of the
 * library. Neither may throw. */
typedef struct cdprep_allocator {
    void* (*allocate)(void* context, size_t size, size_t alignment);
    void (*release)(void* context, void* memory, size_t size);
    void* context; /* passed to both */
} cdprep_allocator;

/* --- Workspaces ----------------------------------------------------------------------------- */

/* Scratch memory for queries, and the caller's threads. */
typedef struct cdprep_workspace cdprep_workspace;

/* The searches through octrees and tetra-trees, in the library cdprep_cells. Link this library only
 * if queries use these structures. */
typedef struct cdprep_cell_searches cdprep_cell_searches;
CDPREP_API const cdprep_cell_searches* cdprep_cells(void);

/* Runs one of the tasks that the library passes to cdprep_workspace_options.run. */
typedef void (*cdprep_task)(const void* work, size_t number);

typedef struct cdprep_workspace_options {
    cdprep_head head;
    /* 1: the number of tasks that `run` may run at once, at most 256; more than 1 requires `run` */
    uint32_t lanes;
    uint32_t counting; /* CDPREP_NO; CDPREP_YES: count the work of queries */
    /* Null; otherwise the caller's function. It calls task(work, 0) ... task(work, count - 1), once
     * each, in any order, on any threads. It returns when all tasks have returned. If `run` skips
     * tasks, the calling thread runs them afterwards. */
    void (*run)(void* context, size_t count, cdprep_task task, const void* work);
    void* context;                     /* null; passed to `run` */
    const cdprep_allocator* allocator; /* null: the heap; copied */
    /* Null; set it to cdprep_cells() for queries through octrees and tetra-trees. */
    const cdprep_cell_searches* cells;
} cdprep_workspace_options;

/* Makes default options: one lane, no threads. Writes `size` bytes, which must be
 * sizeof(cdprep_workspace_options). Null does nothing. */
CDPREP_API void cdprep_workspace_options_init(cdprep_workspace_options* options, size_t size);

/* Stores the number of bytes that cdprep_workspace_make() needs for these options. Each lane takes
 * about 820 KiB, and 360 KiB more with `cells`. `options` may be null. */
CDPREP_API int cdprep_workspace_size(const cdprep_workspace_options* options, size_t* size,
                                     cdprep_error* error);

/* Makes a workspace in the caller's memory. The memory must start at a multiple of
 * CDPREP_ALIGNMENT, have at least cdprep_workspace_size() bytes, and outlive the workspace. If
 * `memory` is null and `size` is 0, the workspace takes its memory from the allocator, in one
 * allocation. `options` may be null. On failure *workspace is null.
 * Errors:
 * - CDPREP_WHY_NULL: `memory` is null and `size` is not 0, or the allocator lacks a function.
 * - CDPREP_WHY_TOO_SMALL: `size` is less than the size from cdprep_workspace_size().
 * - CDPREP_WHY_OUT_OF_RANGE: `lanes` is not 1 to 256, `counting` is unknown, or the memory is not
 *   aligned.
 * - CDPREP_WHY_NO_MEANING: several lanes without `run`, or an allocator in addition to memory.
 * - CDPREP_OVER_BUDGET: there is not enough memory. */
CDPREP_API int cdprep_workspace_make(const cdprep_workspace_options* options, void* memory,
                                     size_t size, cdprep_workspace** workspace,
                                     cdprep_error* error);

/* Ends a workspace and releases the memory that cdprep_workspace_make() allocated. Does nothing for
 * null or a workspace in use. */
CDPREP_API void cdprep_workspace_end(cdprep_workspace* workspace);

/* Indices into cdprep_counts.n. */
enum {
    CDPREP_COUNT_BOX_PAIRS = 0,       /* pairs of boxes tested, one of A's BVH and one of B's */
    CDPREP_COUNT_NODE_PAIRS = 1,      /* pairs of nodes that hold these boxes, up to 8 in each */
    CDPREP_COUNT_LEAF_PAIRS = 2,      /* pairs of leaves whose triangles were tested */
    CDPREP_COUNT_TRIANGLE_PAIRS = 3,  /* pairs of triangles in these leaves */
    CDPREP_COUNT_BY_KERNEL = 4,       /* of the triangle pairs: found to cross in float */
    CDPREP_COUNT_BY_CORNER = 5,       /* of the triangle pairs: decided by a common corner */
    CDPREP_COUNT_BY_FILTER = 6,       /* of the triangle pairs: decided in double */
    CDPREP_COUNT_BY_EXACT = 7,        /* of the triangle pairs: decided in exact arithmetic */
    CDPREP_COUNT_CELL_PAIRS = 8,      /* pairs of leaf cells of octrees and tetra-trees */
    CDPREP_COUNT_POTENTIAL = 9,       /* hashed octree: triangles that may touch the other model */
    CDPREP_COUNT_CELLS_SOUGHT = 10,   /* hashed octree: cells looked up */
    CDPREP_COUNT_REFERENCES = 11,     /* hashed octree: triangles listed by cells; repeats count */
    CDPREP_COUNT_MEASURED = 12,       /* distances of two triangles computed in double */
    CDPREP_COUNT_MEASURED_AGAIN = 13, /* of these distances: computed again for the last digits */
    CDPREP_COUNT_HULL_PAIRS = 14,     /* pairs of convex hulls, in contact queries */
    CDPREP_COUNT_HULL_STEPS = 15,     /* searches for support points, one in each hull */
    CDPREP_COUNT_HULLS_BY_EXACT = 16, /* pairs of hulls that double could not decide */
    CDPREP_COUNT_EXACT_STEPS = 17,    /* searches for support points without rounding */
    CDPREP_COUNT_RAY_TRIANGLES = 18   /* triangles tested against a ray to find what is inside */
};

typedef struct cdprep_counts {
    uint64_t n[32]; /* by CDPREP_COUNT_...; the rest is 0 */
} cdprep_counts;

/* Stores counts of the work of queries with this workspace since it was made, for tuning. Queries
 * about two models, self-overlaps and points inside are counted. Rays, closest points and shapes
 * are not. The counts are not part of any answer, and may differ between processors and versions.
 * Errors: CDPREP_WHY_NO_MEANING if the workspace was made without `counting`. */
CDPREP_API int cdprep_workspace_counts(cdprep_workspace* workspace, cdprep_counts* counts,
                                       cdprep_error* error);

/* --- Poses ------------------------------------------------------------------------------------
 *
 * A pose is a rigid motion: it moves a point p to R p + T. Every function rejects a pose that is
 * not rigid. Every entry of |R^T R - I| must be at most 1e-12, and R must not mirror. Convert
 * matrices from a physics or game engine with cdprep_pose_nearest(). */

typedef struct cdprep_pose {
    double rows[12]; /* R row by row, then T in model units */
} cdprep_pose;

enum { CDPREP_ROWS = 0, CDPREP_COLUMNS = 1 };

/* Makes a pose from a quaternion w + xi + yj + zk of any nonzero length. Each entry of R is within
 * 2^-50 of the exact one. On failure, *pose is all 0, which no function accepts as a pose. The
 * functions below that store a pose also store 0 if they fail.
 * Errors: CDPREP_WHY_OUT_OF_RANGE if the quaternion is 0. */
CDPREP_API int cdprep_pose_from_quaternion(const double wxyz[4], const double translation[3],
                                           cdprep_pose* pose, cdprep_error* error);

/* Makes the pose nearest to a 4 x 4 matrix, whose upper left 3 x 3 block is M. The pose's R
 * minimises the sum of the squared entries of M - R. With the `layout` CDPREP_ROWS, the translation
 * is in elements 3, 7, 11. With CDPREP_COLUMNS, it is in elements 12, 13, 14. The matrix may differ
 * from a rigid motion by `tolerance`, which is 0 to 0.25. The limit holds for every entry of
 * |M^T M - I|. It also holds for the deviation of each entry of the last row from 0 0 0 1. For
 * matrices of floats, a tolerance of 1e-5 is a good value. Every entry of |R^T R - I| of the result
 * is at most 1e-15. Takes about 100 ns.
 * Errors: CDPREP_WHY_NOT_RIGID with a message that states whether the matrix scales, shears,
 * mirrors or projects. */
CDPREP_API int cdprep_pose_nearest(const double matrix[16], uint32_t layout, double tolerance,
                                   cdprep_pose* pose, cdprep_error* error);

/* Does the same for a matrix of floats. */
CDPREP_API int cdprep_pose_nearest_f32(const float matrix[16], uint32_t layout, double tolerance,
                                       cdprep_pose* pose, cdprep_error* error);

/* Stores the pose that moves by `b_from_c` first and then by `a_from_b`. Each number is rounded. If
 * an entry of |R^T R - I| exceeds 1e-13, the nearest rotation replaces R. So chains of poses stay
 * rigid, whatever their length. `a_from_c` may point to either argument.
 * Errors: CDPREP_WHY_OUT_OF_RANGE if the translation exceeds 2^1000. */
CDPREP_API int cdprep_pose_compose(const cdprep_pose* a_from_b, const cdprep_pose* b_from_c,
                                   cdprep_pose* a_from_c, cdprep_error* error);

/* Stores the inverse pose, R^T and -R^T T. Each number is rounded. If an entry of |R R^T - I|
 * exceeds 1e-13, the nearest rotation replaces R^T.
 * Errors: CDPREP_WHY_OUT_OF_RANGE if the translation exceeds 2^1000. */
CDPREP_API int cdprep_pose_inverse(const cdprep_pose* a_from_b, cdprep_pose* b_from_a,
                                   cdprep_error* error);

/* Stores the pose that moves B's points into A's frame: world_from_a^-1 world_from_b. R is Ra^T Rb
 * and T is Ra^T (Tb - Ta), each sum from left to right. If an entry of |R^T R - I| exceeds 1e-12,
 * the nearest rotation replaces R. The result equals that of relative_pose() in C++, bit for bit. A
 * query with CDPREP_MOVE_B moves B by this pose. Takes about 20 ns. `a_from_b` may point to either
 * argument.
 * Errors: CDPREP_WHY_OUT_OF_RANGE if the translation exceeds 2^1000. */
CDPREP_API int cdprep_pose_relative(const cdprep_pose* world_from_a,
                                    const cdprep_pose* world_from_b, cdprep_pose* a_from_b,
                                    cdprep_error* error);

/* Moves `count` points, 3 numbers each, by the formula that all queries use. x becomes
 * ((R00 x + R01 y) + R02 z) + T0, and y and z likewise. The sum is computed in double, without
 * fused multiply-add. A query that moves a model is exact for the vertices that result from this
 * formula. `moved` may be `points`. On failure nothing is stored.
 */
CDPREP_API int cdprep_pose_move(const cdprep_pose* pose, const double* points, size_t count,
                                double* moved, cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_BASE_H */
