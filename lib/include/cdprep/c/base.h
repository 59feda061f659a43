/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_BASE_H
#define CDPREP_C_BASE_H

#include <stddef.h>
#include <stdint.h>

/* What all parts of the C API share: codes, errors, memory, workspaces, poses.
 *
 * Rules that hold for every function:
 *
 * - Order of arguments: the subject, numbers, the workspace, the answer, the error.
 * - The return value is a code. `error` may be null; otherwise it is filled, also on success,
 *   when code and why are 0 and both texts are empty.
 * - A struct that starts with cdprep_head is an input that may grow. Only its _init() function
 *   makes it valid; it writes size, tag and defaults. Every other content, zeros too, is refused
 *   with CDPREP_WHY_NOT_INITIALISED. Null stands for the defaults where a parameter is named
 *   `options`, but for those of a build, which hold the mesh.
 * - Arguments are checked before anything is computed, in this order: nulls; size and tag;
 *   values of enumerations; numbers; poses; fields that have no meaning for the question; what
 *   the model was baked and opened for; whether the workspace is in use. The first mistake is
 *   reported. In a batch one wrong entry refuses the whole batch.
 * - Numbers are finite and at most 2^1000 in magnitude. NaN is always refused. Infinity is
 *   allowed for max_distance, max_t and the limits of boxes alone. No answer holds NaN, and
 *   none holds infinity.
 * - On failure answers say that nothing is known: counts and `found` are 0, `hit`, `inside` and
 *   the like are CDPREP_UNKNOWN. Room for lists may hold anything. Answers are left as they were
 *   where nothing tells how many there are: a query that is null or that its _init() did not
 *   make, a count of more than memory holds. cdprep_pose_move() and cdprep_model_corners() too
 *   leave their answers as they were.
 * - Lengths are in model units. Limits are inclusive. Numbers of triangles and vertices are
 *   those of the imported file, or of the arrays that a model was built from.
 * - A list has room for some answers; `count` says how many there are. Too little room is no
 *   error: as many as fit are stored. No room at all counts.
 * - No question allocates. Opening or building a model and making a workspace do.
 * - Models are read-only and serve any number of threads. A workspace serves one call at a
 *   time. Nothing else is shared: there is no global state.
 * - Callbacks return; they neither throw nor call longjmp(). A visitor may ask questions with
 *   another workspace. It runs in the caller's floating-point environment, and no environment
 *   changes an answer.
 * - A null, closed or foreign pointer is the only thing that can crash a call, and of these null
 *   is refused. */

#ifndef CDPREP_EXPORT /* predefine it to reuse another library's scheme */
#if defined(_WIN32) && defined(CDPREP_BUILDING)
#define CDPREP_EXPORT __declspec(dllexport)
#elif defined(_WIN32) && defined(CDPREP_SHARED)
#define CDPREP_EXPORT __declspec(dllimport)
#elif defined(__GNUC__) && defined(CDPREP_BUILDING)
#define CDPREP_EXPORT __attribute__((visibility("default")))
#else
#define CDPREP_EXPORT
#endif
#endif
#ifdef __cplusplus
#define CDPREP_API extern "C" CDPREP_EXPORT
#else
#define CDPREP_API CDPREP_EXPORT
#endif

#define CDPREP_VERSION_MAJOR 0
#define CDPREP_VERSION_MINOR 1
#define CDPREP_VERSION_PATCH 0
#define CDPREP_ALIGNMENT 64    /* of memory that _make(), _build() and _open_memory() take */
#define CDPREP_NONE UINT32_MAX /* a number of a triangle, vertex, face ... where there is none */

/* The first member of every input struct that may grow. Only _init() functions write it. */
typedef struct cdprep_head {
    uint32_t size; /* of the struct, in bytes, as the caller was compiled */
    uint32_t tag;  /* one value for each type of struct */
} cdprep_head;

/* Codes, the exit codes of the program. 1 and 4 are never returned. Numbers are never reused. */
enum {
    CDPREP_OK = 0,
    CDPREP_BAD_ARGUMENT = 2, /* a mistake of the caller; error.why says which kind */
    CDPREP_UNREADABLE = 3,   /* a file that is missing, malformed or damaged */
    CDPREP_OVER_BUDGET = 5,  /* no memory */
    CDPREP_INTERNAL = 6      /* a mistake of this library */
};

/* Kinds of bad arguments. Numbers are never reused. */
enum {
    CDPREP_WHY_NULL = 1,            /* a pointer that must not be null is */
    CDPREP_WHY_NOT_INITIALISED = 2, /* a struct that its _init() did not make */
    CDPREP_WHY_NEWER_FIELD = 3,     /* a byte that this library does not know is not 0 */
    CDPREP_WHY_OUT_OF_RANGE = 4,    /* an enumerator, a number or an index */
    CDPREP_WHY_NOT_FINITE = 5,      /* NaN, or infinity where it is not allowed */
    CDPREP_WHY_NOT_RIGID = 6,       /* a pose that scales, shears or mirrors */
    CDPREP_WHY_NO_MEANING = 7,      /* a field that this question cannot use has been set */
    CDPREP_WHY_NOT_BAKED = 8,       /* the model does not have what the question needs */
    CDPREP_WHY_NOT_OPENED = 9,      /* the file has it, but it was not asked for at opening */
    CDPREP_WHY_TOO_SMALL = 10,      /* memory */
    CDPREP_WHY_STALE = 11,          /* an object that is gone */
    CDPREP_WHY_BUSY = 12            /* a workspace that another call is using */
};

typedef struct cdprep_error {
    int32_t code;
    int32_t why;       /* of CDPREP_BAD_ARGUMENT; otherwise 0 */
    char argument[56]; /* which one: "pairs[3].pose_b"; ends with a zero */
    char message[448]; /* a whole sentence for a person, cut to fit; ends with a zero */
} cdprep_error;

/* An answer that may be unknown. Compare it; do not test it for 0. */
enum { CDPREP_NO = 0, CDPREP_YES = 1, CDPREP_UNKNOWN = 2 };

typedef struct cdprep_version {
    uint32_t major, minor, patch;          /* of the library that runs, not of this header */
    uint32_t abi;                          /* programs and libraries of one value fit together */
    uint32_t oldest_format, newest_format; /* of the files that it reads */
    char kernels[16];                      /* the instruction set in use: "avx2", "scalar", ... */
} cdprep_version;

/* Stores the version of the library that runs. Null does nothing. */
CDPREP_API void cdprep_version_get(cdprep_version* version);

/* Returns the name of a code, such as "CDPREP_UNREADABLE". Never null: other numbers give
 * "CDPREP_UNKNOWN_CODE". */
CDPREP_API const char* cdprep_code_name(int code);

/* The caller's memory functions. `allocate` returns null when there is no memory; `size` is not
 * 0 and `alignment` a power of two of at most CDPREP_ALIGNMENT. `release` gets the same size.
 * They are called only while a model or workspace is made or ended, by the calling thread. They
 * must not throw. */
typedef struct cdprep_allocator {
    void* (*allocate)(void* context, size_t size, size_t alignment);
    void (*release)(void* context, void* memory, size_t size);
    void* context; /* handed to both */
} cdprep_allocator;

/* --- Workspaces ----------------------------------------------------------------------------- */

/* Scratch memory for questions, and the caller's threads. */
typedef struct cdprep_workspace cdprep_workspace;

/* The searches through octrees and tetra-trees, which only programs link that ask through these:
 * the library cdprep_cells. */
typedef struct cdprep_cell_searches cdprep_cell_searches;
CDPREP_API const cdprep_cell_searches* cdprep_cells(void);

/* Runs one task. */
typedef void (*cdprep_task)(const void* work, size_t number);

typedef struct cdprep_workspace_options {
    cdprep_head head;
    /* 1: how many tasks `run` may run at the same time, at most 256; above 1 needs `run` */
    uint32_t lanes;
    uint32_t counting; /* CDPREP_NO; CDPREP_YES: count what questions do */
    /* Null. Else it calls task(work, 0) ... task(work, count - 1), once each, in any order, on any
     * threads, and returns when all have returned. The calling thread runs the tasks that `run`
     * did not. */
    void (*run)(void* context, size_t count, cdprep_task task, const void* work);
    void* context;                     /* handed to `run` */
    const cdprep_allocator* allocator; /* null: malloc(); read once */
    /* Null. cdprep_cells(), to ask through octrees and tetra-trees. */
    const cdprep_cell_searches* cells;
} cdprep_workspace_options;

/* Makes default options: one lane, no threads. Writes `size` bytes, which is
 * sizeof(cdprep_workspace_options). Null does nothing. */
CDPREP_API void cdprep_workspace_options_init(cdprep_workspace_options* options, size_t size);

/* Stores how many bytes cdprep_workspace_make() needs for these options: about SIZE KiB a lane, and
 * CELLS KiB more with `cells`. `options` may be null. */
CDPREP_API int cdprep_workspace_size(const cdprep_workspace_options* options, size_t* size,
                                     cdprep_error* error);

/* Makes a workspace in the caller's memory, which starts at a multiple of CDPREP_ALIGNMENT, has
 * at least cdprep_workspace_size() bytes and outlives the workspace. Null memory of size 0: one
 * allocation by the allocator. `options` may be null. On failure *workspace is null.
 * Errors: CDPREP_WHY_TOO_SMALL, CDPREP_WHY_OUT_OF_RANGE for the alignment, CDPREP_WHY_NO_MEANING
 * for an allocator beside memory; CDPREP_OVER_BUDGET. */
CDPREP_API int cdprep_workspace_make(const cdprep_workspace_options* options, void* memory,
                                     size_t size, cdprep_workspace** workspace,
                                     cdprep_error* error);

/* Ends a workspace and releases what cdprep_workspace_make() allocated. Null does nothing, nor
 * does a workspace that is in use. */
CDPREP_API void cdprep_workspace_end(cdprep_workspace* workspace);

/* Places in cdprep_counts.n. */
enum {
    CDPREP_COUNT_BOX_PAIRS = 0,      /* boxes of A's hierarchy that were compared with B's */
    CDPREP_COUNT_NODE_PAIRS = 1,     /* nodes, of up to 8 boxes each, that were read for that */
    CDPREP_COUNT_LEAF_PAIRS = 2,     /* pairs of leaves whose triangles were compared */
    CDPREP_COUNT_TRIANGLE_PAIRS = 3, /* pairs of triangles in those */
    CDPREP_COUNT_BY_KERNEL = 4,      /* of these, decided in float */
    CDPREP_COUNT_BY_CORNER = 5,      /* by a common corner */
    CDPREP_COUNT_BY_FILTER = 6,      /* in double */
    CDPREP_COUNT_BY_EXACT = 7,       /* in exact arithmetic */
    CDPREP_COUNT_CELL_PAIRS = 8,     /* leaf cells of octrees and tetra-trees, A's with B's */
    CDPREP_COUNT_POTENTIAL = 9,      /* hashed octree: triangles that may overlap */
    CDPREP_COUNT_CELLS_SOUGHT = 10,  /* hashed octree: cells that were looked up */
    CDPREP_COUNT_REFERENCES = 11,    /* hashed octree: triangles that these cells list */
    CDPREP_COUNT_MEASURED = 12,      /* distances of triangles that were measured in double */
    CDPREP_COUNT_MEASURED_AGAIN = 13,
    CDPREP_COUNT_HULL_PAIRS = 14, /* pairs of convex hulls, within questions about contacts */
    CDPREP_COUNT_HULL_STEPS = 15,
    CDPREP_COUNT_HULLS_BY_EXACT = 16,
    CDPREP_COUNT_EXACT_STEPS = 17,
    CDPREP_COUNT_RAY_TRIANGLES = 18 /* triangles that were tested with a ray for inside */
};

typedef struct cdprep_counts {
    uint64_t n[32]; /* by CDPREP_COUNT_...; the rest is 0 */
} cdprep_counts;

/* Stores what all questions with this workspace did since it was made: for tuning. It is no part
 * of any answer and may differ between processors and versions.
 * Errors: CDPREP_WHY_NO_MEANING where the workspace was made without `counting`. */
CDPREP_API int cdprep_workspace_counts(cdprep_workspace* workspace, cdprep_counts* counts,
                                       cdprep_error* error);

/* --- Poses ------------------------------------------------------------------------------------
 *
 * A pose is a rigid motion: a point p goes to R p + T. A function that takes one refuses what is
 * not rigid: every entry of |R^T R - I| is at most 1e-12, and R does not mirror. Matrices of
 * engines go through cdprep_pose_nearest(). */

typedef struct cdprep_pose {
    double rows[12]; /* R row by row, then T in model units */
} cdprep_pose;

enum { CDPREP_ROWS = 0, CDPREP_COLUMNS = 1 };

/* Makes a pose of a quaternion w + xi + yj + zk of any length but 0. Each entry of R is within
 * 2^-50 of the exact one. On failure all of *pose is 0, which no function takes as a pose; so
 * below. */
CDPREP_API int cdprep_pose_from_quaternion(const double wxyz[4], const double translation[3],
                                           cdprep_pose* pose, cdprep_error* error);

/* Makes the pose that is nearest to a 4 x 4 matrix (the rotation R for which the sum of squares of
 * M - R is least). `layout` is CDPREP_ROWS where translation is in elements 3, 7, 11, or
 * CDPREP_COLUMNS where it is in elements 12, 13, 14. The matrix may differ from a rigid motion by
 * `tolerance`, 0 to 0.25, in every entry of |M^T M - I| and of its last row 0 0 0 1; for matrices
 * of floats 1e-5 is a good value.
 * Errors: CDPREP_WHY_NOT_RIGID with a sentence that says whether it scales, shears, mirrors or
 * projects. Costs some 100 ns. The result satisfies |R^T R - I| <= 1e-15. */
CDPREP_API int cdprep_pose_nearest(const double matrix[16], uint32_t layout, double tolerance,
                                   cdprep_pose* pose, cdprep_error* error);

/* The same for floats. */
CDPREP_API int cdprep_pose_nearest_f32(const float matrix[16], uint32_t layout, double tolerance,
                                       cdprep_pose* pose, cdprep_error* error);

/* Stores the pose that moves by `b_from_c` first and then by `a_from_b`. Each number is rounded;
 * a rotation that has drifted by more than 1e-13 is replaced by the nearest one, so that chains
 * of any length stay rigid. *a_from_c may be either argument.
 * Errors: CDPREP_WHY_OUT_OF_RANGE where the translation exceeds 2^1000. */
CDPREP_API int cdprep_pose_compose(const cdprep_pose* a_from_b, const cdprep_pose* b_from_c,
                                   cdprep_pose* a_from_c, cdprep_error* error);

/* Stores the pose that moves back. Rounded, as cdprep_pose_compose(). */
CDPREP_API int cdprep_pose_inverse(const cdprep_pose* a_from_b, cdprep_pose* b_from_a,
                                   cdprep_error* error);

/* Moves `count` points, 3 numbers each, by the formula that questions use: ((R00 x + R01 y) +
 * R02 z) + T0 and so on, in double, without contraction. A question that moves a model answers
 * exactly for these points. `moved` may be `points`. On failure nothing is stored. */
CDPREP_API int cdprep_pose_move(const cdprep_pose* pose, const double* points, size_t count,
                                double* moved, cdprep_error* error);

#endif /* CDPREP_C_BASE_H */
