/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_MODEL_H
#define CDPREP_C_MODEL_H

#include "cdprep/c/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A baked or built model, open for queries. It is read-only: all functions may use one model on any
 * number of threads at the same time. The models of live models and windows change: see cdprep_live
 * and cdprep_window. */
typedef struct cdprep_model cdprep_model;

/* The features of a model, as bits of a set. A file that was baked for a feature has the sections
 * for it. The "Needs" line of a function names the bits that each of its models must serve. */
enum {
    CDPREP_ASK_COLLIDE = 1 << 0,
    CDPREP_ASK_OVERLAP = 1 << 1,
    CDPREP_ASK_DISTANCE = 1 << 2,
    CDPREP_ASK_WITHIN = 1 << 3,
    CDPREP_ASK_CONTACTS = 1 << 4,
    CDPREP_ASK_RESPONSE = 1 << 5,   /* contacts, and mass properties */
    CDPREP_ASK_CONTINUOUS = 1 << 6, /* the time of impact of two models that move */
    CDPREP_ASK_SELF = 1 << 7,       /* overlaps of a model with itself */
    CDPREP_ASK_DEFORM = 1 << 8,     /* base of a live model */
    CDPREP_ASK_TEAR = 1 << 9,       /* base of a live model that can tear */
    CDPREP_ASK_HAPTIC = 1 << 10,    /* distances within a limit of work */
    CDPREP_ASK_INSIDE = 1 << 11,
    CDPREP_ASK_RAY = 1 << 12,
    CDPREP_ASK_CLOSEST = 1 << 13,
    CDPREP_ASK_TOUCH = 1 << 14,        /* queries with boxes, spheres, capsules, triangles */
    CDPREP_ASK_HULLS = 1 << 15,        /* convex hulls */
    CDPREP_ASK_PIECES = 1 << 16,       /* convex pieces of the surface, and queries through them */
    CDPREP_ASK_CORNERS = 1 << 17,      /* geometry: corners, mesh, names, numbers of the file */
    CDPREP_ASK_INACCESSIBLE = 1 << 18, /* triangles occluded from the tetra-tree's centre */
    CDPREP_ASK_OCTREE = 1 << 20,
    CDPREP_ASK_ADAPTIVE_OCTREE = 1 << 21,
    CDPREP_ASK_TETRA_TREE = 1 << 22,
    CDPREP_ASK_HASHED_OCTREE = 1 << 23,
    CDPREP_ASK_SOLID = 1 << 30 /* collide, distance and containment of solids */
};

/* Returns the name of one CDPREP_ASK_ bit, as messages and `cdprep bake` use it: "collide". Returns
 * null for a set of bits and for a bit that this version does not know. */
CDPREP_API const char* cdprep_ask_name(uint32_t ask);

/* The mode in which a file is opened. */
enum {
    CDPREP_MAP = 0,  /* Memory-mapped and validated. Processes share the memory. */
    CDPREP_COPY = 1, /* Read and checked. The file may be changed or removed afterwards. */
    CDPREP_MAP_TRUSTED =
        2 /* Mapped; only the header is checked. A damaged file may crash a query. */
};

typedef struct cdprep_open_options {
    cdprep_head head;
    /* 0: opens all sections of the file. Otherwise opens the sections that these CDPREP_ASK_ bits
     * need or use. Fails if the file does not serve all of these bits. The box, provenance,
     * findings, verdicts and repaired_from are opened too. CDPREP_MAP_TRUSTED always opens all
     * sections. */
    uint32_t ask;
    uint32_t mode;    /* CDPREP_MAP */
    const char* name; /* null: a name for bytes in memory, used in messages; UTF-8, copied */
    const cdprep_allocator* allocator; /* null: the heap; copied */
} cdprep_open_options;

/* Makes default options. Writes `size` bytes, which must be sizeof(cdprep_open_options). Null does
 * nothing. */
CDPREP_API void cdprep_open_options_init(cdprep_open_options* options, size_t size);

/* Opens a baked file and validates what `ask` requests. CDPREP_MAP_TRUSTED validates only the
 * header. `options` may be null. On failure *model is null. Takes O(bytes of the sections) time, at
 * memory speed. A model that serves CDPREP_ASK_CORNERS also takes 4 bytes of memory per triangle.
 * If the model has several components, it takes 4 more bytes per vertex.
 * A mapped file must not be changed in place or truncated while it is open. Replacing it by
 * a rename is safe: the model keeps the old file mapped.
 * Errors:
 * - CDPREP_UNREADABLE: the file is missing, damaged or of another kind.
 * - CDPREP_WHY_NOT_BAKED: the file lacks what `ask` requires; the message names the `bake` option.
 * - CDPREP_WHY_NO_MEANING: options.name is set, but messages use the path.
 * - CDPREP_OVER_BUDGET: there is not enough memory. */
CDPREP_API int cdprep_model_open(const char* utf8_path, const cdprep_open_options* options,
                                 cdprep_model** model, cdprep_error* error);

/* Opens the bytes of a baked file in memory in the same way. They must start at a multiple of
 * CDPREP_ALIGNMENT and stay unchanged while the model is open; CDPREP_COPY requires neither.
 * CDPREP_MAP_TRUSTED is refused with CDPREP_WHY_NO_MEANING. */
CDPREP_API int cdprep_model_open_memory(const void* bytes, size_t size,
                                        const cdprep_open_options* options, cdprep_model** model,
                                        cdprep_error* error);

/* Closes a model. No call may be using the model. Does nothing for null. Also does nothing for a
 * model that belongs to a live model (cdprep_live_model()) or a window (cdprep_window_model()). */
CDPREP_API void cdprep_model_close(cdprep_model* model);

/* Returns CDPREP_OK if a model serves all bits of `ask`. Otherwise fails as a query that needs
 * `ask` would: with CDPREP_WHY_NOT_BAKED or CDPREP_WHY_NOT_OPENED.
 * Errors: these, and CDPREP_WHY_OUT_OF_RANGE for bits that this version does not know. */
CDPREP_API int cdprep_model_serves(const cdprep_model* model, uint32_t ask, cdprep_error* error);

/* Reads a byte of every page that the queries in `ask` may read. The first query then does not wait
 * for the disk. Errors: those of cdprep_model_serves(). */
CDPREP_API int cdprep_model_prefetch(const cdprep_model* model, uint32_t ask, cdprep_error* error);

typedef struct cdprep_model_info {
    uint32_t triangles, vertices; /* of a window: the vertices it has room for */
    uint32_t components; /* connected components; 0 if not listed in the file or not opened */
    uint32_t instances, groups, materials; /* of the imported file; 0 as above */
    uint32_t pieces, hulls;                /* convex pieces and convex hulls; 0 as above */
    uint32_t verdicts;         /* of the mesh and its components; see cdprep_model_verdict() */
    uint32_t serves;           /* CDPREP_ASK_ bits */
    uint32_t balanced;         /* CDPREP_YES: solid queries have exact answers; else CDPREP_NO */
    uint32_t stores_f64;       /* CDPREP_YES: coordinates are doubles; CDPREP_NO: floats */
    double lower[3], upper[3]; /* a box around all triangles, model units; 0 without triangles */
    double metres_per_unit;    /* 0: not known */
    uint64_t hash[2];          /* [0]: of the content, equal for equal input and options; [1]: 0 */
    uint64_t reserved[4];      /* 0 */
} cdprep_model_info;

/* Stores facts about a model. */
CDPREP_API int cdprep_model_describe(const cdprep_model* model, cdprep_model_info* info,
                                     cdprep_error* error);

/* The facts about one triangle. A number that the imported file does not give is CDPREP_NONE. */
typedef struct cdprep_corners {
    double point[3][3];  /* by corner, then x, y, z; model units, exactly as stored */
    uint32_t vertex[3];  /* numbers of the imported file; for merged vertices the lowest */
    uint32_t face;       /* the polygon of the triangle, numbered within its instance */
    uint32_t instance;   /* the scene node that the triangle came with */
    uint32_t group;      /* number for cdprep_model_text() with CDPREP_GROUP_NAME */
    uint32_t material;   /* number for cdprep_model_text() with CDPREP_MATERIAL_NAME */
    uint32_t component;  /* connected component */
    uint32_t degenerate; /* CDPREP_YES: the corners are collinear */
    uint32_t reserved;   /* 0 */
} cdprep_corners;

/* Stores the facts about `count` triangles. `triangles` are their numbers in the imported file,
 * below cdprep_model_info.triangles. Takes O(log r) time per triangle. Here r is the number of runs
 * of consecutive triangles with the same instance, group or material.
 * Errors: CDPREP_WHY_OUT_OF_RANGE with the index of the invalid number; then nothing is stored.
 * Needs: CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_model_corners(const cdprep_model* model, const uint32_t* triangles,
                                    size_t count, cdprep_corners* corners, cdprep_error* error);

/* Room for a mesh, and the size of the mesh. An array without room may be null. */
typedef struct cdprep_mesh {
    double* positions;   /* 3 per vertex, model units */
    uint32_t* triangles; /* 3 per triangle, rows of `positions`, counter-clockwise from outside */
    uint32_t* vertices;  /* number of each vertex in the imported file; may always be null */
    size_t vertex_room, triangle_room;   /* input */
    size_t vertex_count, triangle_count; /* output */
} cdprep_mesh;

/* Stores the mesh: triangles in the order of the imported file, vertices after merging. Stores as
 * many vertices and triangles as there is room for. The counts are those of the whole mesh.
 * Allocates only for the model of a live model with max_triangles.
 * Needs: CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_model_mesh(const cdprep_model* model, cdprep_mesh* mesh, cdprep_error* error);

typedef struct cdprep_array {
    const void* data; /* null if there is none */
    size_t count;     /* elements */
    size_t stride;    /* bytes from one element to the next */
} cdprep_array;

/* Stores the address of a section; nothing is copied. Elements are in the order of the file (tree
 * order for triangles). The address is valid as long as the model. FORMAT.md lists the sections and
 * their elements. Section 24 (repaired_from) holds the number of each triangle before a repair.
 * Errors: CDPREP_WHY_OUT_OF_RANGE if no section has this number; CDPREP_WHY_NOT_BAKED if the file
 * lacks the section; CDPREP_WHY_NOT_OPENED if the model was opened without it. */
CDPREP_API int cdprep_model_section(const cdprep_model* model, uint32_t section,
                                    cdprep_array* array, cdprep_error* error);

/* Stores the address of all bytes of a model, to save or to send. The stride is 1, and the count is
 * the number of bytes. cdprep_model_open_memory() accepts a copy of them. The address is valid as
 * long as the model. Copies nothing; takes O(1) time.
 * Errors: CDPREP_WHY_NO_MEANING for the model of a live model (see cdprep_live_image()) or of a
 * window. */
CDPREP_API int cdprep_model_bytes(const cdprep_model* model, cdprep_array* bytes,
                                  cdprep_error* error);

enum {
    CDPREP_PROVENANCE = 0,    /* JSON: how the file was made */
    CDPREP_FINDINGS = 1,      /* JSON: the defects found in the mesh, and the repairs */
    CDPREP_INSTANCE_NAME = 2, /* the path of the scene node cdprep_corners.instance */
    CDPREP_GROUP_NAME = 3,
    CDPREP_MATERIAL_NAME = 4
};

/* Stores the address and the length of a UTF-8 text, valid as long as the model. The text does not
 * end with a zero: use the length. If the model has no text of the first two kinds, *text is null
 * and *length is 0. `number` must be 0 for these kinds. Errors: CDPREP_WHY_OUT_OF_RANGE for a kind
 * that does not exist, and for a number without a name. */
CDPREP_API int cdprep_model_text(const cdprep_model* model, uint32_t kind, uint32_t number,
                                 const char** text, size_t* length, cdprep_error* error);

typedef struct cdprep_mass {
    double volume;     /* cubic model units; negative if the surface is inside out */
    double centre[3];  /* of mass, model units */
    double inertia[6]; /* tensor about the centre, density 1, model axes: xx, yy, zz, xy, yz, zx */
} cdprep_mass;

/* Stores the mass properties of a balanced model. The file has none if the mesh is not balanced or
 * its volume is 0. Of CDPREP_ASK_RESPONSE, the function needs only the mass properties, not the
 * contacts.
 * Needs: CDPREP_ASK_RESPONSE */
CDPREP_API int cdprep_model_mass(const cdprep_model* model, cdprep_mass* mass, cdprep_error* error);

/* Bits of cdprep_verdict.facts. If a bit is not set, its fact is false. Exception: without
 * CDPREP_FACT_CROSSINGS_EXAMINED, it is unknown whether the mesh crosses itself. */
enum {
    CDPREP_FACT_CLOSED = 1,
    CDPREP_FACT_TWO_MANIFOLD = 2,
    CDPREP_FACT_ORIENTED = 4,
    CDPREP_FACT_ORIENTABLE = 8,
    CDPREP_FACT_BALANCED = 16,
    CDPREP_FACT_INVERTED = 32,
    CDPREP_FACT_CROSSINGS_EXAMINED = 64,
    CDPREP_FACT_SELF_CROSSING = 128
};
/* Bits of cdprep_verdict.promises. */
enum {
    CDPREP_PROMISE_SURFACE = 1,         /* queries about the surface are exact */
    CDPREP_PROMISE_INSIDE_EXACT = 2,    /* inside is decided exactly */
    CDPREP_PROMISE_SIMPLE_SOLID = 4,    /* in addition, the winding number is 0 or 1 everywhere */
    CDPREP_PROMISE_CONTAINED_PIECES = 8 /* hulls of convex pieces can lie within the solid */
};

typedef struct cdprep_verdict {
    uint32_t facts, promises;
    uint32_t triangles;
    uint32_t first_triangle; /* the lowest number of a triangle without a repeated corner, or 0 */
    uint32_t boundary_loops;
    int32_t euler;
    int32_t genus; /* -1 unless the mesh is a closed, orientable 2-manifold */
    uint32_t reserved;
    double area;   /* square model units */
    double volume; /* cubic model units, signed; 0 unless balanced */
} cdprep_verdict;

/* Stores the facts about the mesh that the bake recorded. Number 0 is the whole mesh; the other
 * numbers are its components, in the order of first_triangle.
 * Errors: CDPREP_WHY_OUT_OF_RANGE for a number that is not below cdprep_model_info.verdicts. */
CDPREP_API int cdprep_model_verdict(const cdprep_model* model, uint32_t number,
                                    cdprep_verdict* verdict, cdprep_error* error);

/* Stores the error of cdprep_collide_at_level() at a level of the tetra-tree, in model units. At
 * each level, each cone has an outer and an inner facet. All parts of triangles in the cone lie
 * between them, except triangles that contain the tree's centre. The error is an upper bound of the
 * distance between these two facets, along rays from the centre. It is 0 for a model without
 * triangles. Beyond the deepest level, the error is that of the deepest level. On failure *bound is
 * 0. Takes O(cones of the level) time. The library cdprep_cells contains this function.
 * Needs: CDPREP_ASK_TETRA_TREE */
CDPREP_API int cdprep_model_level_error(const cdprep_model* model, uint32_t level, double* bound,
                                        cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_MODEL_H */
