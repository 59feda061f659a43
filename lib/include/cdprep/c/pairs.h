/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_PAIRS_H
#define CDPREP_C_PAIRS_H

#include "cdprep/c/model.h"

/* Questions about two models.
 *
 * All are exact, the same on every machine: the answer is that of exact arithmetic on the
 * vertices as the poses move them (cdprep_pose_move()). A model without triangles touches
 * nothing. */

/* Which model's vertices move. It matters to the last bit: moving rounds. */
enum {
    CDPREP_MOVE_B = 0, /* B moves into A's frame, by pose_a^-1 pose_b; A stays as it is stored */
    CDPREP_MOVE_A = 1, /* A moves into B's frame, by pose_b^-1 pose_a; B stays as it is stored */
    /* Both move, each by its own pose. Parts of one assembly that share vertices and a pose
     * still share them: touching stays touching. */
    CDPREP_MOVE_BOTH = 2
};
/* What a model is. */
enum {
    CDPREP_SURFACE = 0, /* its triangles */
    CDPREP_SOLID = 1    /* and what they enclose */
};
/* What counts as an overlap of two triangles. */
enum {
    CDPREP_CLOSED = 0, /* any common point: touching counts */
    CDPREP_PROPER = 1  /* they cross, or share area in one plane */
};
/* Handling of degenerate triangles (collinear corners). */
enum {
    CDPREP_KEEP_DEGENERATE = 0, /* they answer as the segment or point that they are */
    CDPREP_SKIP_DEGENERATE = 1  /* they never answer */
};
/* The structure through which a question is answered. The answers are the same; the time is not.
 * Through another one than the BVH a model must also serve its CDPREP_ASK_ bit. */
enum {
    CDPREP_THROUGH_BVH = 0,
    CDPREP_THROUGH_OCTREE = 1,
    CDPREP_THROUGH_ADAPTIVE_OCTREE = 2,
    CDPREP_THROUGH_HASHED_OCTREE = 3,
    CDPREP_THROUGH_TETRA_TREE = 4,
    CDPREP_THROUGH_PIECES = 5 /* the hierarchy over convex pieces */
};

/* The result of earlier queries on one pair of models. The next query starts from it, and is
 * faster where the models have moved little. All zero is a new one. Any content is safe: what a
 * query did not write itself counts as new. One for each pair of models and thread. */
typedef struct cdprep_cache {
    uint64_t words[32];
} cdprep_cache;

/* Two models, how they are placed, and what counts. Each question says which of `body`, `overlap`,
 * `degenerate` and `through` it uses; the others must be at their defaults. */
typedef struct cdprep_pair {
    cdprep_head head;
    const cdprep_model* a;
    const cdprep_model* b;
    cdprep_cache* cache;        /* null */
    uint32_t moving;            /* CDPREP_MOVE_B */
    uint32_t body;              /* CDPREP_SURFACE */
    uint32_t overlap;           /* CDPREP_CLOSED */
    uint32_t degenerate;        /* CDPREP_KEEP_DEGENERATE */
    uint32_t through;           /* CDPREP_THROUGH_BVH */
    uint32_t reserved;          /* 0 */
    cdprep_pose pose_a, pose_b; /* into the world; identity */
} cdprep_pair;

/* Makes a pair without models: B moves, both poses are the identity. Then `pose_b` alone maps B
 * into A's frame. Writes `size` bytes, which is sizeof(cdprep_pair). */
CDPREP_API void cdprep_pair_init(cdprep_pair* pair, size_t size);

typedef struct cdprep_collision {
    uint32_t hit;         /* CDPREP_NO, _YES, _UNKNOWN */
    uint32_t containment; /* of solids whose surfaces do not touch: whether one is inside */
    uint32_t a_inside_b;  /* where containment is not CDPREP_NO: CDPREP_YES A in B, else B in A */
    uint32_t reserved;    /* 0 */
    double winding;       /* the winding number that decided; 0 where containment is CDPREP_NO */
} cdprep_collision;

/* Whether two models collide. It stops at the first pair of triangles.
 * Of surfaces: whether they have a common point; one inside the other without contact does not
 * collide. Of solids: also whether a component of one is inside the other. A component inside an
 * open surface gives `containment` CDPREP_UNKNOWN with the generalised winding number, and `hit`
 * CDPREP_UNKNOWN.
 * Uses body, overlap, degenerate; through: any of surfaces and solids.
 * Costs O(log n) for most poses; O(1) with a cache where little has moved.
 * Needs: CDPREP_ASK_COLLIDE; CDPREP_SOLID: also CDPREP_ASK_SOLID */
CDPREP_API int cdprep_collide(const cdprep_pair* pair, cdprep_workspace* workspace,
                              cdprep_collision* collision, cdprep_error* error);

/* Whether a component of one model is inside the other, for models whose surfaces do not touch:
 * `hit` and `containment` say the same. Touching surfaces give an answer without meaning; ask
 * cdprep_collide() with CDPREP_SOLID where that is possible.
 * Inside means a winding number other than 0. Exact for closed models.
 * Costs O(components (log n + hits)), against an open model O(n) a component.
 * Needs: CDPREP_ASK_COLLIDE, CDPREP_ASK_SOLID */
CDPREP_API int cdprep_containment(const cdprep_pair* pair, cdprep_workspace* workspace,
                                  cdprep_collision* collision, cdprep_error* error);

/* Whether two solids collide, as far as one level of their tetra-trees can tell: CDPREP_NO and
 * CDPREP_YES are proved, CDPREP_UNKNOWN means that this level is too coarse
 * (cdprep_model_level_error()). Costs O(pairs of cones that meet).
 * Needs: CDPREP_ASK_TETRA_TREE */
CDPREP_API int cdprep_collide_at_level(const cdprep_pair* pair, uint32_t level,
                                       cdprep_workspace* workspace, uint32_t* hit,
                                       cdprep_error* error);

/* One triangle of each model. */
typedef struct cdprep_overlap {
    uint32_t a, b;
} cdprep_overlap;

typedef struct cdprep_overlap_list {
    cdprep_overlap* items; /* null with room 0: counts */
    size_t room;           /* given */
    size_t count;          /* answered: how many there are, also beyond the room */
} cdprep_overlap_list;

/* Called with each answer and the caller's context; 0 ends the search. */
typedef int (*cdprep_overlap_visitor)(void* context, const cdprep_overlap* overlap);

/* All pairs of triangles that overlap, sorted by a, then b. Too little room keeps the smallest.
 * Uses overlap, degenerate; through: any.
 * Costs O(log n + pairs) for compact surfaces, O(n m) at worst.
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_overlaps(const cdprep_pair* pair, cdprep_workspace* workspace,
                               cdprep_overlap_list* list, cdprep_error* error);

/* The same list, found on all lanes of the workspace: for one question that takes a millisecond
 * or more. Leaves the cache alone. Uses overlap, degenerate.
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_overlaps_split(const cdprep_pair* pair, cdprep_workspace* workspace,
                                     cdprep_overlap_list* list, cdprep_error* error);

/* Calls `visit` with each pair once, as it is found, in no particular order. Returns CDPREP_OK
 * also where the visitor ended the search. Uses overlap, degenerate.
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_overlaps_visit(const cdprep_pair* pair, cdprep_workspace* workspace,
                                     cdprep_overlap_visitor visit, void* context,
                                     cdprep_error* error);

/* A bit for each triangle: bit i % 64 of word i / 64. */
typedef struct cdprep_marks {
    uint64_t* bits_a; /* null with 0 words: A's are not wanted */
    uint64_t* bits_b;
    size_t words_a; /* 0, or at least a word for every 64 triangles */
    size_t words_b;
    size_t count; /* answered: pairs that overlap */
} cdprep_marks;

/* Marks the triangles of either model that overlap any of the other, and clears all other bits.
 * Faster than a list where many pairs share few triangles. Uses overlap, degenerate.
 * Errors: CDPREP_WHY_TOO_SMALL for too few words.
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_overlaps_mark(const cdprep_pair* pair, cdprep_workspace* workspace,
                                    cdprep_marks* marks, cdprep_error* error);

/* A pair of triangles that overlap, and the segment that they have in common. */
typedef struct cdprep_crossing {
    cdprep_overlap pair;
    uint32_t is_flat;  /* CDPREP_YES: in one plane, or one has no area; then the ends are 0 */
    uint32_t reserved; /* 0 */
    double ends[2][3]; /* in no particular order; equal where they touch in a point */
} cdprep_crossing;

typedef struct cdprep_crossing_list {
    cdprep_crossing* items;
    size_t room, count;
} cdprep_crossing_list;

typedef int (*cdprep_crossing_visitor)(void* context, const cdprep_crossing* crossing);

/* All pairs of cdprep_overlaps() with their segments, in the frame that the models are moved to.
 * The list is in the order of (a, b), and too little room keeps the smallest; visits are in no
 * particular order. The ends are chosen exactly and then rounded once (at most half a
 * unit in the last place, plus 2^-45): neighbours share them bit for bit. Uses overlap,
 * degenerate. Costs some microseconds a pair more than cdprep_overlaps().
 * Needs: CDPREP_ASK_OVERLAP */
CDPREP_API int cdprep_crossings(const cdprep_pair* pair, cdprep_workspace* workspace,
                                cdprep_crossing_list* list, cdprep_error* error);
CDPREP_API int cdprep_crossings_visit(const cdprep_pair* pair, cdprep_workspace* workspace,
                                      cdprep_crossing_visitor visit, void* context,
                                      cdprep_error* error);

/* How exact a distance is to be. Either permitted error ends the search; 0 and 0 ask for all that
 * double can tell. */
typedef struct cdprep_distance_options {
    cdprep_head head;
    double relative_error; /* 0: upper may exceed lower by this share of lower */
    double absolute_error; /* 0: or by this, model units */
    double max_distance;   /* distances above this are reported as not found; default: infinity */
} cdprep_distance_options;

CDPREP_API void cdprep_distance_options_init(cdprep_distance_options* options, size_t size);

typedef struct cdprep_nearest {
    uint32_t found; /* CDPREP_NO: nothing within max_distance; then the rest is 0 */
    uint32_t triangle_a, triangle_b; /* that the points lie on; CDPREP_NONE for hulls and shapes */
    uint32_t reserved;               /* 0 */
    double lower, upper;             /* the exact distance lies between, model units */
    double on_a[3], on_b[3]; /* nearest points, up to rounding, in the frame the models move to */
} cdprep_nearest;

/* How far two models are apart. Surfaces that touch are 0 apart, exactly; solids also where one
 * is proved inside the other, with the nearest points of the surfaces. Without permitted errors
 * the interval is at most 1e-12 of the distance plus 1e-15 of the largest coordinate wide.
 * Of equally near triangles those with the lowest numbers answer. `options` may be null.
 * Uses body; through: CDPREP_THROUGH_BVH, CDPREP_THROUGH_PIECES.
 * Costs O(log n) for compact surfaces, every triangle at worst.
 * Needs: CDPREP_ASK_DISTANCE; CDPREP_SOLID: also CDPREP_ASK_SOLID */
CDPREP_API int cdprep_distance(const cdprep_pair* pair, const cdprep_distance_options* options,
                               cdprep_workspace* workspace, cdprep_nearest* nearest,
                               cdprep_error* error);

/* Whether two surfaces are at most `tolerance` apart, 0 or more: exact to the last bit.
 * Uses through: CDPREP_THROUGH_BVH, CDPREP_THROUGH_PIECES. Costs less than a distance.
 * Needs: CDPREP_ASK_WITHIN */
CDPREP_API int cdprep_within(const cdprep_pair* pair, double tolerance, cdprep_workspace* workspace,
                             uint32_t* within, cdprep_error* error);

/* All pairs of triangles that are at most `tolerance` apart, sorted by a, then b; exact.
 * Uses degenerate; through: CDPREP_THROUGH_BVH, CDPREP_THROUGH_PIECES.
 * Needs: CDPREP_ASK_WITHIN */
CDPREP_API int cdprep_pairs_within(const cdprep_pair* pair, double tolerance,
                                   cdprep_workspace* workspace, cdprep_overlap_list* list,
                                   cdprep_error* error);

/* Calls `visit` with each of these pairs, in no particular order. Uses degenerate.
 * Needs: CDPREP_ASK_WITHIN */
CDPREP_API int cdprep_pairs_within_visit(const cdprep_pair* pair, double tolerance,
                                         cdprep_workspace* workspace, cdprep_overlap_visitor visit,
                                         void* context, cdprep_error* error);

/* `count` questions on the lanes of the workspace: the same answers as one by one, in the same
 * order. All pairs are checked first; where one is wrong none is asked, and error.argument says
 * which ("pairs[3].pose_b"). Pairs follow each other by the size in the head of the first. No two
 * share a cache. A batch is faster than single calls from about ten queries. Each uses and
 * needs what the single question does. */
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

#endif /* CDPREP_C_PAIRS_H */
