/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_MODEL_H
#define CDPREP_C_MODEL_H

#include "cdprep/c/base.h"

/* A baked or built model that is open for questions. It is read-only: all functions may use one
 * model on any number of threads at the same time. */
typedef struct cdprep_model cdprep_model;

/* What a model can be asked for, as bits of a set. A file that was baked for something has the
 * sections that it needs. The "Needs" line of a function says which bits both models must
 * serve. */
enum {
    CDPREP_ASK_COLLIDE = 1 << 0,
    CDPREP_ASK_OVERLAP = 1 << 1,
    CDPREP_ASK_DISTANCE = 1 << 2,
    CDPREP_ASK_WITHIN = 1 << 3,
    CDPREP_ASK_CONTACTS = 1 << 4,
    CDPREP_ASK_RESPONSE = 1 << 5, /* mass properties */
    /* 6 to 10: of scenes and live models, not yet in this version, which refuses them */
    CDPREP_ASK_INSIDE = 1 << 11,
    CDPREP_ASK_RAY = 1 << 12,
    CDPREP_ASK_CLOSEST = 1 << 13,
    CDPREP_ASK_TOUCH = 1 << 14,   /* boxes, spheres, capsules, triangles */
    CDPREP_ASK_HULLS = 1 << 15,   /* convex hulls */
    CDPREP_ASK_PIECES = 1 << 16,  /* convex pieces of the surface, and questions through them */
    CDPREP_ASK_CORNERS = 1 << 17, /* geometry: corners, mesh, names, numbers of the file */
    CDPREP_ASK_INACCESSIBLE = 1 << 18,
    CDPREP_ASK_OCTREE = 1 << 20,
    CDPREP_ASK_ADAPTIVE_OCTREE = 1 << 21,
    CDPREP_ASK_TETRA_TREE = 1 << 22,
    CDPREP_ASK_HASHED_OCTREE = 1 << 23,
    CDPREP_ASK_SOLID = 1 << 30 /* collide, distance and containment: of solids */
};

/* How a file gets into memory. */
enum {
    CDPREP_MAP = 0,  /* Memory-mapped and validated. Processes share the memory. */
    CDPREP_COPY = 1, /* read and checked: the file may be changed or removed afterwards */
    CDPREP_MAP_TRUSTED =
        2 /* mapped, only its header checked: a damaged file may crash a question */
};

typedef struct cdprep_open_options {
    cdprep_head head;
    uint32_t ask;     /* 0: whatever the file has; else all of these bits, or opening fails */
    uint32_t mode;    /* CDPREP_MAP */
    const char* name; /* null: what messages call bytes in memory; UTF-8, read once */
    const cdprep_allocator* allocator; /* null: malloc(); copied */
} cdprep_open_options;

/* Makes default options. Writes `size` bytes, which is sizeof(cdprep_open_options). */
CDPREP_API void cdprep_open_options_init(cdprep_open_options* options, size_t size);

/* Opens a baked file and checks all of it that is asked for. `options` may be null. On failure
 * *model is null. Costs the bytes of the sections, at memory speed; with CDPREP_ASK_CORNERS also
 * 4 bytes of memory a triangle and, where there are several components, 4 a vertex.
 * A file that is mapped must not be changed in place or made shorter while it is open; replacing
 * it by renaming another is safe.
 * Errors: CDPREP_UNREADABLE; CDPREP_WHY_NOT_BAKED where `ask` wants what the file does not have,
 * with the `bake` option that adds it; CDPREP_WHY_NO_MEANING for a name, which is the path;
 * CDPREP_OVER_BUDGET. */
CDPREP_API int cdprep_model_open(const char* utf8_path, const cdprep_open_options* options,
                                 cdprep_model** model, cdprep_error* error);

/* The same for bytes in memory, which start at a multiple of CDPREP_ALIGNMENT and stay as they
 * are while the model is open; with CDPREP_COPY neither is demanded. CDPREP_MAP_TRUSTED has no
 * meaning. */
CDPREP_API int cdprep_model_open_memory(const void* bytes, size_t size,
                                        const cdprep_open_options* options, cdprep_model** model,
                                        cdprep_error* error);

/* Closes a model. Null does nothing. No call may be using it. */
CDPREP_API void cdprep_model_close(cdprep_model* model);

/* Returns CDPREP_OK when a model serves all bits of `ask`, otherwise the refusal that a question
 * with this need would get: CDPREP_WHY_NOT_BAKED or CDPREP_WHY_NOT_OPENED, with the sentence. */
CDPREP_API int cdprep_model_serves(const cdprep_model* model, uint32_t ask, cdprep_error* error);

/* Reads a byte of every page that questions of these kinds may read, so that the first question
 * does not wait for the disk. Errors: those of cdprep_model_serves(). */
CDPREP_API int cdprep_model_prefetch(const cdprep_model* model, uint32_t ask, cdprep_error* error);

typedef struct cdprep_model_info {
    uint32_t triangles, vertices;
    uint32_t components; /* connected parts; 0 where the file does not say or it was not opened */
    uint32_t instances, groups, materials; /* of the imported file; likewise */
    uint32_t pieces, hulls;                /* convex pieces and convex hulls; likewise */
    uint32_t verdicts;   /* of cdprep_model_verdict(): of the whole mesh, then of components */
    uint32_t serves;     /* CDPREP_ASK_ bits */
    uint32_t closed;     /* CDPREP_YES: solid questions have exact answers; else CDPREP_NO */
    uint32_t stores_f64; /* CDPREP_YES: coordinates are doubles; CDPREP_NO: floats */
    double lower[3], upper[3]; /* a box around all triangles, model units; 0 without triangles */
    double metres_per_unit;    /* 0: not known */
    uint64_t hash[2];          /* of the content: the same input and options give the same */
    uint64_t reserved[4];      /* 0 */
} cdprep_model_info;

/* Stores facts about a model. */
CDPREP_API int cdprep_model_describe(const cdprep_model* model, cdprep_model_info* info,
                                     cdprep_error* error);

/* What is known of one triangle. Where the imported file says nothing: CDPREP_NONE. */
typedef struct cdprep_corners {
    double point[3][3];  /* by corner, then x, y, z; model units, exactly as stored */
    uint32_t vertex[3];  /* numbers of the imported file; of vertices that were merged the lowest */
    uint32_t face;       /* polygon of its instance; the triangle where every face is one */
    uint32_t instance;   /* the node that it came with */
    uint32_t group;      /* CDPREP_GROUP_NAME of cdprep_model_text() */
    uint32_t material;   /* CDPREP_MATERIAL_NAME */
    uint32_t component;  /* connected part */
    uint32_t degenerate; /* CDPREP_YES: the corners are collinear */
    uint32_t reserved;   /* 0 */
} cdprep_corners;

/* Stores what is known of `count` triangles, which are given by their numbers in the imported
 * file, below cdprep_model_info.triangles. Costs O(log) of the number of runs a triangle.
 * Errors: CDPREP_WHY_OUT_OF_RANGE with the place of the wrong number; then nothing is stored.
 * Needs: CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_model_corners(const cdprep_model* model, const uint32_t* triangles,
                                    size_t count, cdprep_corners* corners, cdprep_error* error);

/* Room for a mesh, and how large it is. An array of no room may be null. */
typedef struct cdprep_mesh {
    double* positions;   /* 3 a vertex, model units */
    uint32_t* triangles; /* 3 rows of `positions` a triangle, counter-clockwise from outside */
    uint32_t* vertices;  /* number in the imported file of each vertex; may always be null */
    size_t vertex_room, triangle_room;   /* given */
    size_t vertex_count, triangle_count; /* answered */
} cdprep_mesh;

/* Stores the mesh: triangles in the order of the imported file, vertices as they are merged. As
 * many vertices and triangles as there is room for; the counts say how many there are.
 * Needs: CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_model_mesh(const cdprep_model* model, cdprep_mesh* mesh, cdprep_error* error);

typedef struct cdprep_array {
    const void* data; /* null when there is none */
    size_t count;     /* elements */
    size_t stride;    /* bytes from one element to the next */
} cdprep_array;

/* Stores where a section of the file is in memory: no copy, in the order of the file (for
 * triangles the tree order), alive as long as the model. FORMAT.md lists the sections and what
 * their elements are; section 24 (repaired_from) holds, by triangle, its number before a
 * repair.
 * Errors: CDPREP_WHY_OUT_OF_RANGE for a number that is no section; CDPREP_WHY_NOT_BAKED and
 * CDPREP_WHY_NOT_OPENED for one that is not there. */
CDPREP_API int cdprep_model_section(const cdprep_model* model, uint32_t section,
                                    cdprep_array* array, cdprep_error* error);

enum {
    CDPREP_PROVENANCE = 0,    /* JSON: how the file was made */
    CDPREP_FINDINGS = 1,      /* JSON: what was found wrong with the mesh, and what was repaired */
    CDPREP_INSTANCE_NAME = 2, /* of cdprep_corners.instance: the path of its node */
    CDPREP_GROUP_NAME = 3,
    CDPREP_MATERIAL_NAME = 4
};

/* Stores where a text is, UTF-8, alive as long as the model. It does not end with a zero: use the
 * length. Null and 0 where the file has none. `number` is 0 for the first two kinds.
 * Errors: CDPREP_WHY_OUT_OF_RANGE for a kind or a number that does not exist. */
CDPREP_API int cdprep_model_text(const cdprep_model* model, uint32_t kind, uint32_t number,
                                 const char** text, size_t* length, cdprep_error* error);

typedef struct cdprep_mass {
    double volume;     /* cubic model units; negative where the surface is inside out */
    double centre[3];  /* of mass, model units */
    double inertia[6]; /* about the centre, density 1, model axes: xx, yy, zz, xy, yz, zx */
} cdprep_mass;

/* Stores the mass properties of a closed model. A file of a model that is not closed has none.
 * Needs: CDPREP_ASK_RESPONSE */
CDPREP_API int cdprep_model_mass(const cdprep_model* model, cdprep_mass* mass, cdprep_error* error);

/* Bits of cdprep_verdict.facts. One that is not set is false; SELF_CROSSING is known only where
 * CROSSINGS_EXAMINED is set. */
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
    CDPREP_PROMISE_SURFACE = 1,         /* questions about the surface are exact */
    CDPREP_PROMISE_INSIDE_EXACT = 2,    /* inside is decided exactly */
    CDPREP_PROMISE_SIMPLE_SOLID = 4,    /* and the winding number is 0 or 1 everywhere */
    CDPREP_PROMISE_CONTAINED_PIECES = 8 /* convex pieces may lie within the solid */
};

typedef struct cdprep_verdict {
    uint32_t facts, promises;
    uint32_t triangles;
    uint32_t first_triangle; /* the lowest number */
    uint32_t boundary_loops;
    int32_t euler;
    int32_t genus; /* -1: none */
    uint32_t reserved;
    double area;   /* square model units */
    double volume; /* cubic model units, signed; 0 unless balanced */
} cdprep_verdict;

/* Stores what was found of the mesh when it was baked: number 0 of the whole, the others of its
 * components. Errors: CDPREP_WHY_OUT_OF_RANGE for a number that is not below
 * cdprep_model_info.verdicts. */
CDPREP_API int cdprep_model_verdict(const cdprep_model* model, uint32_t number,
                                    cdprep_verdict* verdict, cdprep_error* error);

/* Stores how far the outer and inner facets of a level of the tetra-tree are apart at most, model
 * units: the error of cdprep_collide_at_level(). Levels beyond the deepest answer as that. On
 * failure *bound is 0. Costs O(cones of the level).
 * Needs: CDPREP_ASK_TETRA_TREE */
CDPREP_API int cdprep_model_level_error(const cdprep_model* model, uint32_t level, double* bound,
                                        cdprep_error* error);

#endif /* CDPREP_C_MODEL_H */
