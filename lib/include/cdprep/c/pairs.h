/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_PAIRS_H
#define CDPREP_C_PAIRS_H

#include "cdprep/c/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Queries about two models, and about one model against itself.
 *
 * Answers are exact: they are those of exact arithmetic on the vertices as the poses move them
 * (cdprep_pose_move()). Distances have proven bounds. Unless a comment says otherwise, answers are
 * the same on every machine. A model without triangles touches nothing. */

/* The model whose vertices the query moves: A, B or both. The choice matters in the last bits,
 * because moving rounds coordinates. */
enum {
    CDPREP_MOVE_B = 0, /* B moves into A's frame, by pose_a^-1 pose_b; A does not move */
    CDPREP_MOVE_A = 1, /* A moves into B's frame, by pose_b^-1 pose_a; B does not move */
    /* Both move, each by its own pose. If two models have common vertices and equal poses, these
     * vertices stay identical, so the models still touch. */
    CDPREP_MOVE_BOTH = 2
};
/* The point set that represents a model. */
enum {
    CDPREP_SURFACE = 0, /* its triangles */
    CDPREP_SOLID = 1    /* its triangles and what they enclose */
};
/* The kind of common points that makes two triangles overlap. */
enum {
    CDPREP_CLOSED = 0, /* any common point: touching counts */
    CDPREP_PROPER = 1  /* they cross, or share area in one plane */
};
/* The treatment of degenerate triangles (collinear corners). */
enum {
    CDPREP_KEEP_DEGENERATE = 0, /* they count as the segment or point that they are */
    CDPREP_SKIP_DEGENERATE = 1  /* they are ignored */
};
/* The structure through which a query is computed. It changes the time but not the answer, with two
 * exceptions. cdprep_distance() through pieces may name another pair of touching triangles. With
 * permitted errors, it may store another result within them. For a structure other than the BVH, a
 * model must also serve the CDPREP_ASK_ bit of the structure. For octrees and tetra-trees, the
 * workspace must have `cells` (cdprep_workspace_options). */
enum {
    CDPREP_THROUGH_BVH = 0,
    CDPREP_THROUGH_OCTREE = 1,
    CDPREP_THROUGH_ADAPTIVE_OCTREE = 2,
    CDPREP_THROUGH_HASHED_OCTREE = 3,
    CDPREP_THROUGH_TETRA_TREE = 4,
    CDPREP_THROUGH_PIECES = 5 /* the hierarchy over convex pieces */
};

/* The result of earlier queries on one pair of models. The next query starts from it, and is faster
 * if the models have moved little. It never changes the answer, with one exception. With permitted
 * errors, cdprep_distance() may store another result within them. A zero-filled struct is a new
 * cache. Any content is safe: content that no query wrote is treated as a new cache. Use one for
 * each pair of models and thread. */
typedef struct cdprep_cache {
    uint64_t words[32];
} cdprep_cache;

/* Separating planes between parts of two models, from earlier distance queries through pieces. If
 * the models move little from query to query, few planes have to be updated. The first distance
 * query fills the front, and takes about three times as long as a query without a front. A
 * zero-filled struct is a new front. Any content is safe, as in cdprep_cache. Use one for each pair
 * of models and thread. */
typedef struct cdprep_front {
    uint64_t words[3600];
} cdprep_front;

/* Two models, their placement, and the options of the query. Each query states which of `body`,
 * `overlap`, `degenerate` and `through` it uses. The others must be at their defaults. */
typedef struct cdprep_pair {
    cdprep_head head;
    const cdprep_model* a;
    const cdprep_model* b;
    /* Null. Queries may use it through CDPREP_THROUGH_BVH, or together with a front. */
    cdprep_cache* cache;
    uint32_t moving;            /* CDPREP_MOVE_B */
    uint32_t body;              /* CDPREP_SURFACE */
    uint32_t overlap;           /* CDPREP_CLOSED */
    uint32_t degenerate;        /* CDPREP_KEEP_DEGENERATE */
    uint32_t through;           /* CDPREP_THROUGH_BVH */
    uint32_t reserved;          /* 0 */
    cdprep_pose pose_a, pose_b; /* identity; from model to world coordinates */
    /* Null; used only by cdprep_distance() and cdprep_within() through CDPREP_THROUGH_PIECES, if
     * there is a cache too. Like a cache, it changes an answer only within permitted errors. */
    cdprep_front* front;
} cdprep_pair;

/* Makes a pair without models: B moves, and both poses are the identity. Then `pose_b` alone maps B
 * into A's frame. Writes `size` bytes, which must be sizeof(cdprep_pair). */
CDPREP_API void cdprep_pair_init(cdprep_pair* pair, size_t size);

typedef struct cdprep_collision {
    uint32_t hit; /* CDPREP_NO, _YES, _UNKNOWN */
    /* CDPREP_NO, _YES, _UNKNOWN: a component of one model is inside the other. CDPREP_NO for
     * surfaces, and for solids with triangles that overlap. */
    uint32_t containment;
    uint32_t a_inside_b; /* CDPREP_YES: A in B; CDPREP_NO: B in A, or containment is CDPREP_NO */
    uint32_t reserved;   /* 0 */
    double winding;      /* the winding number that decided; 0 if containment is CDPREP_NO */
} cdprep_collision;

/* Stores whether two models collide. Stops at the first pair of triangles that overlap. Surfaces
 * collide if triangles of both overlap. Nested surfaces that do not touch do not collide. Solids
 * also collide if a component of one is inside the other. An unbalanced surface has no defined
 * inside. If a component may be inside one, and no other component is proven inside, `hit` and
 * `containment` are CDPREP_UNKNOWN. Then `winding` is the generalised winding number, and its last
 * digits depend on the C library. `winding` is 0 if the model that may be inside has gained or lost
 * triangles (cdprep/c/live.h).
 * With CDPREP_PROPER, triangles may touch without an overlap. If a vertex that would decide then
 * lies on the other surface, all vertices are tested. CDPREP_UNKNOWN means: the other model is
 * unbalanced, or every vertex of a component may lie on that model's surface. It is also stored if
 * the model that may be inside has gained or lost triangles.
 * Reads `body`, `overlap`, `degenerate` and `through`: any structure, for surfaces and solids.
 * Takes O(log n) time for most poses, O(1) with a cache if little has moved. If no triangles
 * overlap, CDPREP_SOLID adds the time of cdprep_containment(), or of testing all vertices.
 * Needs: CDPREP_ASK_COLLIDE; CDPREP_SOLID: also CDPREP_ASK_SOLID */
CDPREP_API int cdprep_collide(const cdprep_pair* pair, cdprep_workspace* workspace,
                              cdprep_collision* collision, cdprep_error* error);

/* Stores whether a component of one model is inside the other, for models whose surfaces do not
 * touch. `hit` and `containment` are equal. For touching surfaces the answer has no meaning. If the
 * surfaces may touch, use cdprep_collide() with CDPREP_SOLID.
 * Inside means a winding number other than 0. Exact for balanced models
 * (cdprep_model_info.balanced). An unbalanced model can make the answer unknown, as in
 * cdprep_collide(). Reads none of the options; `body` stays CDPREP_SURFACE.
 * Takes O(components (log n + ray hits)) time, or O(n) per component against an unbalanced model.
 * Needs: CDPREP_ASK_COLLIDE, CDPREP_ASK_SOLID */
CDPREP_API int cdprep_containment(const cdprep_pair* pair, cdprep_workspace* workspace,
                                  cdprep_collision* collision, cdprep_error* error);

/* Stores whether two solids collide, if `level` of both tetra-trees can prove it. CDPREP_NO and
 * CDPREP_YES are proven. CDPREP_UNKNOWN means that this level does not decide
 * (cdprep_model_level_error()). CDPREP_YES requires that both models are balanced and contain the
 * centre of their tetra-tree. A level beyond the deepest counts as the deepest. The workspace must
 * have `cells` (cdprep_workspace_options). Reads none of the options; `body` stays CDPREP_SURFACE.
 * Takes O(pairs of cones that meet) time.
 * Needs: CDPREP_ASK_TETRA_TREE */
CDPREP_API int cdprep_collide_at_level(const cdprep_pair* pair, uint32_t level,
                                       cdprep_workspace* workspace, uint32_t* hit,
                                       cdprep_error* error);

/* One triangle of each model. */
typedef struct cdprep_overlap {
    uint32_t a, b;
} cdprep_overlap;

typedef struct cdprep_overlap_list {
    cdprep_overlap* items; /* null with room 0: only counts */
    size_t room;           /* input */
    size_t count;          /* output: the number of all pairs, also beyond the room */
} cdprep_overlap_list;

/* Receives each answer and the caller's context; returning 0 ends the search. */
typedef int (*cdprep_overlap_visitor)(void* context, const cdprep_overlap* overlap);

/* Lists all pairs of triangles that overlap, sorted by a, then b. If there are more pairs than
 * `room`, the list keeps the smallest pairs.
 * Reads `overlap`, `degenerate` and `through`: any structure.
 * Takes O(log n + pairs) time for typical meshes, O(n m) in the worst case.
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_overlaps(const cdprep_pair* pair, cdprep_workspace* workspace,
                               cdprep_overlap_list* list, cdprep_error* error);

/* Stores the list of cdprep_overlaps(), computed on all lanes of the workspace. Use this function
 * for a query that takes a millisecond or more. Does not use the cache.
 * Reads `overlap` and `degenerate`.
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_overlaps_split(const cdprep_pair* pair, cdprep_workspace* workspace,
                                     cdprep_overlap_list* list, cdprep_error* error);

/* Calls `visit` with each pair once, as it is found, in no particular order. Returns CDPREP_OK even
 * if the visitor ended the search. Reads `overlap` and `degenerate`.
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_overlaps_visit(const cdprep_pair* pair, cdprep_workspace* workspace,
                                     cdprep_overlap_visitor visit, void* context,
                                     cdprep_error* error);

/* Marks of triangles: bit i % 64 of word i / 64 for triangle i. */
typedef struct cdprep_marks {
    uint64_t* bits_a; /* null with 0 words: no marks of A */
    uint64_t* bits_b;
    /* 0, or at least a word for every 64 triangles; for live models, see cdprep/c/live.h */
    size_t words_a;
    size_t words_b;
    size_t count; /* output: pairs that overlap */
} cdprep_marks;

/* Marks the triangles of each model that overlap any triangle of the other, and clears all other
 * bits. Takes less time than cdprep_overlaps() if few triangles form many pairs.
 * Reads `overlap` and `degenerate`. Errors: CDPREP_WHY_TOO_SMALL for too few words.
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_overlaps_mark(const cdprep_pair* pair, cdprep_workspace* workspace,
                                    cdprep_marks* marks, cdprep_error* error);

/* A pair of triangles that overlap, and their common segment. */
typedef struct cdprep_crossing {
    cdprep_overlap pair;
    uint32_t is_flat;  /* CDPREP_YES: both in one plane, or one has no area; the ends are 0 */
    uint32_t reserved; /* 0 */
    double ends[2][3]; /* in no particular order; equal if the triangles touch in a point */
} cdprep_crossing;

typedef struct cdprep_crossing_list {
    cdprep_crossing* items;
    size_t room, count;
} cdprep_crossing_list;

typedef int (*cdprep_crossing_visitor)(void* context, const cdprep_crossing* crossing);

/* Both functions find the pairs of cdprep_overlaps() with their common segments. Coordinates are in
 * the frame into which the models move. The list is in the order of (a, b); if there is too little
 * room, it keeps the smallest pairs. Visits are in no particular order. The edges on which a
 * segment ends are determined exactly. The coordinates are then rounded once. Their error is at
 * most half a unit in the last place, plus 2^-45 of a unit. Subnormal coordinates may be off by one
 * unit in the last place. Triangles that share an edge get bit-identical segment ends on it, except
 * where these 2^-45 decide the rounding.
 * Reads `overlap` and `degenerate`. Takes some microseconds more per pair than cdprep_overlaps().
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_crossings(const cdprep_pair* pair, cdprep_workspace* workspace,
                                cdprep_crossing_list* list, cdprep_error* error);
CDPREP_API int cdprep_crossings_visit(const cdprep_pair* pair, cdprep_workspace* workspace,
                                      cdprep_crossing_visitor visit, void* context,
                                      cdprep_error* error);

/* The limits of a distance query. The search ends at either permitted error. With both 0, the
 * interval has the width that the query states. */
typedef struct cdprep_distance_options {
    cdprep_head head;
    double relative_error; /* 0: upper may exceed lower by this share of lower */
    double absolute_error; /* 0: or upper may exceed lower by this, model units */
    double max_distance;   /* infinity; larger distances are not found */
} cdprep_distance_options;

CDPREP_API void cdprep_distance_options_init(cdprep_distance_options* options, size_t size);

typedef struct cdprep_nearest {
    uint32_t found; /* CDPREP_NO: nothing within max_distance; then the rest is 0 */
    uint32_t triangle_a, triangle_b; /* with on_a and on_b; CDPREP_NONE on hulls and shapes */
    uint32_t reserved;               /* 0 */
    double lower, upper;             /* bounds of the exact distance, model units */
    double on_a[3], on_b[3]; /* nearest points, up to rounding, in the frame the models move to */
} cdprep_nearest;

/* Stores the distance of two models. It is 0, exactly, for surfaces that touch. With CDPREP_SOLID,
 * it is also 0 if a component of one model is proven inside the other. The points are then the
 * surfaces' nearest points. Without permitted errors, the interval's width is at most 1e-12 d +
 * 1e-15 c. Here d is the distance, and c the largest absolute coordinate of the moved vertices. If
 * the surfaces are apart and no errors are permitted, the result is a pair of triangles with the
 * least `upper`. If there are several, it is the first in the order of (triangle_a, triangle_b).
 * Surfaces that touch give a pair of triangles that touches. Which one depends on the instruction
 * set and the structure. With permitted errors, the result may be any pair and interval within
 * them. This choice may depend on `cache`, `front`, `through` and the instruction set.
 * `options` may be null.
 * Reads `body` and `through`: CDPREP_THROUGH_BVH or CDPREP_THROUGH_PIECES.
 * Takes O(log n) time for typical meshes; visits every triangle in the worst case.
 * Needs: CDPREP_ASK_DISTANCE; CDPREP_SOLID: also CDPREP_ASK_SOLID */
CDPREP_API int cdprep_distance(const cdprep_pair* pair, const cdprep_distance_options* options,
                               cdprep_workspace* workspace, cdprep_nearest* nearest,
                               cdprep_error* error);

/* A distance, or bounds of it if the search ended early. */
typedef struct cdprep_bounded {
    /* CDPREP_YES: `nearest` is the answer of cdprep_distance(). With permitted errors, it may be
     * another answer within those errors. CDPREP_NO: the answer is late. CDPREP_UNKNOWN: the call
     * failed. */
    uint32_t complete;
    uint32_t reserved; /* 0 */
    uint64_t work;     /* the work done */
    double lower;      /* the distance is at least this; at most 2^1000 */
    /* The nearest pair of triangles found, with bounds of the distance of the models. If `found` is
     * CDPREP_NO, none was found, or none is within max_distance. */
    cdprep_nearest nearest;
} cdprep_bounded;

/* Stores the distance of two surfaces, or bounds of it if the work does not suffice. `work` is the
 * maximum, and 0 is no limit. A pair of nodes of the BVHs counts 1, a pair of leaves 2. A pair of
 * triangles counts 4 in double and 16 in exact arithmetic. The work may exceed the maximum by that
 * of up to 64 pairs of triangles. With a cache, late bounds are tight if little has moved. A late
 * answer depends on the instruction set, because the counted work does. `options` may be null. No
 * clock is read: measure how much work the time allows.
 * Through: CDPREP_THROUGH_BVH. Takes as long as cdprep_distance(), or in proportion to `work`.
 * Needs: CDPREP_ASK_DISTANCE */
CDPREP_API int cdprep_distance_bounded(const cdprep_pair* pair,
                                       const cdprep_distance_options* options, uint64_t work,
                                       cdprep_workspace* workspace, cdprep_bounded* bounded,
                                       cdprep_error* error);

/* Stores whether two surfaces are at most `tolerance` apart. `tolerance` must be at least 0. Exact
 * to the last bit.
 * Reads `through`: CDPREP_THROUGH_BVH or CDPREP_THROUGH_PIECES.
 * Takes as long as cdprep_distance(), or less if the distance differs clearly from `tolerance`.
 * Needs: CDPREP_ASK_WITHIN */
CDPREP_API int cdprep_within(const cdprep_pair* pair, double tolerance, cdprep_workspace* workspace,
                             uint32_t* within, cdprep_error* error);

/* Lists all pairs of triangles that are at most `tolerance` apart, sorted by a, then b. `tolerance`
 * must be at least 0. Exact.
 * Reads `degenerate` and `through`: CDPREP_THROUGH_BVH or CDPREP_THROUGH_PIECES.
 * Needs: CDPREP_ASK_WITHIN */
CDPREP_API int cdprep_pairs_within(const cdprep_pair* pair, double tolerance,
                                   cdprep_workspace* workspace, cdprep_overlap_list* list,
                                   cdprep_error* error);

/* Calls `visit` with each pair of cdprep_pairs_within(), in no particular order.
 * Reads `degenerate`.
 * Needs: CDPREP_ASK_WITHIN */
CDPREP_API int cdprep_pairs_within_visit(const cdprep_pair* pair, double tolerance,
                                         cdprep_workspace* workspace, cdprep_overlap_visitor visit,
                                         void* context, cdprep_error* error);

/* --- One model against itself ---------------------------------------------------------------- */

/* A model, and the options of the query. */
typedef struct cdprep_self_query {
    cdprep_head head;
    const cdprep_model* model;
    uint32_t overlap;    /* CDPREP_CLOSED */
    uint32_t degenerate; /* CDPREP_KEEP_DEGENERATE */
} cdprep_self_query;

CDPREP_API void cdprep_self_query_init(cdprep_self_query* query, size_t size);

/* Lists all pairs of triangles of one model that overlap and share no vertex, sorted by a, then b.
 * Both are triangles of the model, a < b. If there are more pairs than `room`, the list keeps the
 * smallest pairs. Exact, for the model's own positions.
 * Triangles share a vertex if they use the same vertex number. A bake merges vertices with equal
 * positions. Two vertices of a live model may move to one position later. They remain two vertices,
 * so their triangles then touch. A model built or baked for CDPREP_ASK_OVERLAP alone may lack
 * vertex numbers.
 * Takes O(n + pairs) time for typical meshes, O(n^2) in the worst case.
 * Needs: CDPREP_ASK_OVERLAP, CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_self_overlaps(const cdprep_self_query* query, cdprep_workspace* workspace,
                                    cdprep_overlap_list* list, cdprep_error* error);

/* Calls `visit` with each pair of cdprep_self_overlaps() once, as it is found, in no particular
 * order. Returns CDPREP_OK even if the visitor ended the search.
 * Needs: CDPREP_ASK_OVERLAP, CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_self_overlaps_visit(const cdprep_self_query* query,
                                          cdprep_workspace* workspace, cdprep_overlap_visitor visit,
                                          void* context, cdprep_error* error);

/* --- Batches --------------------------------------------------------------------------------- */

/* Each function runs `count` queries on the lanes of the workspace. Element i of the answers is
 * that of a single call for pairs[i]. All pairs are checked first. If one is invalid, no query
 * runs, and error.argument names it ("pairs[3].pose_b"). The size in the head of the first pair is
 * the stride of the array. No two pairs may share a cache or a front. With several lanes, a batch
 * of about ten queries or more is faster than single calls. Each function uses the same fields and
 * needs the same CDPREP_ASK_ bits as its single query. */
CDPREP_API int cdprep_collide_many(const cdprep_pair* pairs, size_t count,
                                   cdprep_workspace* workspace, cdprep_collision* collisions,
                                   cdprep_error* error);
CDPREP_API int cdprep_distance_many(const cdprep_pair* pairs, size_t count,
                                    const cdprep_distance_options* options,
                                    cdprep_workspace* workspace, cdprep_nearest* nearest,
                                    cdprep_error* error);
CDPREP_API int cdprep_within_many(const cdprep_pair* pairs, size_t count, double tolerance,
                                  cdprep_workspace* workspace, uint32_t* within,
                                  cdprep_error* error);
CDPREP_API int cdprep_overlaps_many(const cdprep_pair* pairs, size_t count,
                                    cdprep_workspace* workspace, cdprep_overlap_list* lists,
                                    cdprep_error* error);
CDPREP_API int cdprep_overlaps_mark_many(const cdprep_pair* pairs, size_t count,
                                         cdprep_workspace* workspace, cdprep_marks* marks,
                                         cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_PAIRS_H */
