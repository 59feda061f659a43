/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_CONTACTS_H
#define CDPREP_C_CONTACTS_H

#include "cdprep/c/pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Contacts between convex pieces of two surfaces, and queries about convex hulls. */

enum { CDPREP_VERTEX = 0, CDPREP_EDGE = 1, CDPREP_FACE = 2 };

/* A vertex, edge or face, numbered as in the imported file. Unknown numbers are CDPREP_NONE. */
typedef struct cdprep_feature {
    uint32_t kind;      /* CDPREP_VERTEX, _EDGE, _FACE */
    uint32_t edge;      /* of an edge: it starts at this corner of `triangle`, ends at the next */
    uint32_t triangle;  /* one that has the vertex or edge, or that contains the contact point */
    uint32_t vertex[3]; /* the vertex, the ends of the edge, or three corners of the face */
} cdprep_feature;

typedef struct cdprep_contact_point {
    double on_a[3], on_b[3];
    double distance; /* from on_a to on_b along the normal; negative: overlap */
    /* Stays the same after a small motion. 0 without clusters for the contact's own on_a and on_b,
     * which may be the only points. */
    uint64_t id;
} cdprep_contact_point;

/* Bits of cdprep_contact.flags. */
enum {
    /* the hulls have a common point, and either both lie within their solids or the pieces'
     * triangles touch. Also set with CDPREP_CONTACT_DEEP. */
    CDPREP_CONTACT_OVERLAP = 1,
    /* the shortest direction snags at an edge inside a surface; the normal has another direction */
    CDPREP_CONTACT_INTERNAL_EDGE = 2,
    /* the contact is on the inner side of a surface; ignore it for contact response */
    CDPREP_CONTACT_FROM_BEHIND = 4,
    /* a component of one model is inside the other; points are on hulls: see cdprep_contacts() */
    CDPREP_CONTACT_DEEP = 8
};

/* A contact of two convex pieces. Points are in the frame into which the models move. */
typedef struct cdprep_contact {
    uint32_t piece_a, piece_b;
    /* Stays the same as long as the two pieces are in contact. The high 32 bits are the source
     * number of a triangle of A's piece, the low 32 bits that of B's. With CDPREP_CONTACT_DEEP, the
     * half of the enclosing model is CDPREP_NONE. A cluster has the smallest id of its members. */
    uint64_t id;
    cdprep_feature feature_a, feature_b; /* for an edge or face, only vertex[0] is known */
    uint32_t flags;
    uint32_t point_count; /* in `points`; 0 with neither a manifold nor clusters */
    uint32_t members;     /* the number of contacts in this cluster; 1 without clusters */
    uint32_t reserved;    /* 0 */
    double on_a[3], on_b[3];
    double normal[3]; /* from A to B, of length 1 up to rounding */
    /* Bounds of the exact distance; negative: overlap. No translation shorter than -upper separates
     * overlapping pieces. A translation of B by -lower along the normal separates them. */
    double lower, upper;
    cdprep_contact_point points[4]; /* the deepest first */
} cdprep_contact;

typedef struct cdprep_contact_list {
    cdprep_contact* items;
    size_t room;       /* input */
    size_t count;      /* output: contacts or clusters, at most cdprep_contact_options.most */
    uint32_t complete; /* output: CDPREP_NO if `most` or `work` left contacts out */
    uint32_t searched; /* output: CDPREP_NO if `work` ended the search for near triangles */
    /* output: pairs of pieces found within the tolerance, and enclosed components */
    uint64_t found;
    uint64_t computed; /* output: those of them whose contact was computed */
    uint64_t work;     /* output: the work done, counted as in cdprep_contact_options.work */
} cdprep_contact_list;

typedef struct cdprep_contact_options {
    cdprep_head head;
    double tolerance;  /* 0: pieces at most this far apart are in contact */
    uint32_t manifold; /* 0: none; 4: contacts come with up to four points */
    uint32_t most;     /* 256: the maximum length of a list, 1 to 256 */
    /* 0: no limit; otherwise the maximum work. Each pair of near triangles counts 1. Each contact
     * counts 32 and, between two pieces, 1 for every 8 of their triangles. The search for near
     * triangles takes at most half of the work. The last contact may bring the total above it. The
     * work may allow all contacts, and `most` fewer than half of them. Then some depths are bounded
     * more closely first, and each of these bounds counts 8. */
    uint64_t work;
    /* 0: no clusters. Otherwise, contacts that are linked by common pieces are joined if their
     * normals differ little. The value limits the angle to the normal of the deepest one, in
     * radians. A joined contact has at most four points. */
    double cluster_angle;
} cdprep_contact_options;

typedef int (*cdprep_contact_visitor)(void* context, const cdprep_contact* contact);

CDPREP_API void cdprep_contact_options_init(cdprep_contact_options* options, size_t size);

/* Finds one contact for each pair of convex pieces that have triangles at most `tolerance` apart.
 * This test is exact, as in cdprep_pairs_within(). The list is sorted by `upper`, the deepest
 * first, then by piece_a and piece_b. At most `most` are listed. If there are more, the choice
 * alternates between the deepest remaining contact and the one farthest from all chosen ones.
 * `items` holds as many of the first contacts as it has room for. `options` may be null.
 * With CDPREP_SOLID, a component that is proven to be inside the other model makes a contact of its
 * own. No contact of this kind is made if any triangles of the two models touch. If places are few,
 * the list keeps these contacts before others. Moving B by -lower along the normal frees the
 * component, and no translation shorter than -upper does. The translation leads out of convex hulls
 * that enclose the other model. If that model serves CDPREP_ASK_HULLS, these hulls are its parts
 * or, without parts, its whole hull. Otherwise, the only hull is its bounding box.
 * Reads `body`, `degenerate` and `through`: CDPREP_THROUGH_BVH or CDPREP_THROUGH_PIECES.
 * Takes the time of cdprep_pairs_within(), plus up to 10 microseconds per contact that is computed.
 * CDPREP_SOLID adds the time of cdprep_containment().
 * Needs: CDPREP_ASK_CONTACTS; CDPREP_SOLID: also CDPREP_ASK_SOLID */
CDPREP_API int cdprep_contacts(const cdprep_pair* pair, const cdprep_contact_options* options,
                               cdprep_workspace* workspace, cdprep_contact_list* list,
                               cdprep_error* error);

/* Calls `visit` with all contacts in the order of (piece_a, piece_b), and then with those of
 * enclosed components. `most` and `cluster_angle` must keep their defaults: the visitor gets each
 * contact, and may end the search.
 * Needs: CDPREP_ASK_CONTACTS; CDPREP_SOLID: also CDPREP_ASK_SOLID */
CDPREP_API int cdprep_contacts_visit(const cdprep_pair* pair, const cdprep_contact_options* options,
                                     cdprep_workspace* workspace, cdprep_contact_visitor visit,
                                     void* context, cdprep_error* error);

/* --- Convex hulls: they are solid, and queries about them take no workspace ------------------- */

enum {
    CDPREP_HULL_WHOLE = 0,     /* around the whole model; number 0 */
    CDPREP_HULL_COMPONENT = 1, /* around a connected component */
    CDPREP_HULL_INSTANCE = 2,  /* around an instance of the imported file */
    CDPREP_HULL_PART = 3,      /* around a part; all parts together enclose the model */
    CDPREP_HULL_PIECE = 4      /* around a convex piece; numbered as cdprep_contact.piece_a */
};

/* One convex hull of a model, valid as long as the model. */
typedef struct cdprep_hull {
    const cdprep_model* model; /* null: no hull */
    uint32_t scope, number;
} cdprep_hull;

/* Finds a hull. If there is none with this number, hull->model is null, and the code is CDPREP_OK.
 * On failure, hull->model is null too.
 * Needs: CDPREP_ASK_HULLS; CDPREP_HULL_PIECE: only CDPREP_ASK_PIECES, CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_hull_find(const cdprep_model* model, uint32_t scope, uint32_t number,
                                cdprep_hull* hull, cdprep_error* error);

/* Stores corners and facets of a hull, as cdprep_model_mesh() does. A flat hull has facets on
 * both sides. A hull that is a segment or a point has no facets.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hull_mesh(const cdprep_hull* hull, cdprep_mesh* mesh, cdprep_error* error);

/* The result of the last query on one pair of hulls. The next query starts there. A zero-filled
 * struct is a new cache; any content is safe. A cache never changes whether hulls collide or are
 * within a distance. It may change the last digits of bounds, or change bounds by the permitted
 * errors. Among equally near points, it may change which ones are found. */
typedef struct cdprep_hull_cache {
    uint64_t words[8];
} cdprep_hull_cache;

/* Two hulls and their placement, as in cdprep_pair. */
typedef struct cdprep_hull_pair {
    cdprep_head head;
    cdprep_hull a, b;
    cdprep_hull_cache* cache;   /* null */
    uint32_t moving;            /* CDPREP_MOVE_B */
    uint32_t reserved;          /* 0 */
    cdprep_pose pose_a, pose_b; /* identity */
} cdprep_hull_pair;

CDPREP_API void cdprep_hull_pair_init(cdprep_hull_pair* pair, size_t size);

/* Stores whether two hulls have a common point; touching counts. Exact.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hulls_collide(const cdprep_hull_pair* pair, uint32_t* hit,
                                    cdprep_error* error);

/* Stores the distance of two hulls; it is 0 if they have a common point. Without permitted errors,
 * the interval's width is at most 1e-12 upper + 1e-14 s. Here s is the size of the Minkowski
 * difference A - B: the largest difference along an axis between points of A and B. relative_error
 * is a share of `upper` here. `options` may be null.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hulls_distance(const cdprep_hull_pair* pair,
                                     const cdprep_distance_options* options,
                                     cdprep_nearest* nearest, cdprep_error* error);

/* Stores whether two hulls are at most `tolerance` apart. `tolerance` must be at least 0. Exact to
 * the last bit.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hulls_within(const cdprep_hull_pair* pair, double tolerance, uint32_t* within,
                                   cdprep_error* error);

typedef struct cdprep_penetration {
    uint32_t found;          /* CDPREP_NO: no common point; then the rest is 0 */
    uint32_t reserved;       /* 0 */
    double lower, upper;     /* bounds of the exact penetration depth, model units */
    double normal[3];        /* the direction in which B must move, of length 1 up to rounding */
    double on_a[3], on_b[3]; /* the points that touch after this motion */
} cdprep_penetration;

/* Stores the penetration depth of two hulls. It is the length of the shortest translation of B
 * after which they only touch. relative_error is a share of `upper` here. `options` may be null.
 * Takes the time of ten to a hundred distance queries.
 * Errors: CDPREP_WHY_NO_MEANING for a finite max_distance.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hulls_penetration(const cdprep_hull_pair* pair,
                                        const cdprep_distance_options* options,
                                        cdprep_penetration* penetration, cdprep_error* error);

typedef struct cdprep_closest_features {
    uint32_t found;      /* CDPREP_NO: the hulls have a common point; then the rest is 0 */
    uint32_t parallel;   /* CDPREP_YES: other points may be as near */
    cdprep_feature a, b; /* the nearest features; only kind and vertex are known */
    double lower, upper; /* bounds of the exact distance, model units */
    double on_a[3], on_b[3];
} cdprep_closest_features;

/* Stores the nearest features of two hulls of convex pieces. Both scopes must be
 * CDPREP_HULL_PIECE: other hulls have no features. With a cache, takes O(1) time if little has
 * moved.
 * Needs: CDPREP_ASK_CONTACTS */
CDPREP_API int cdprep_hulls_features(const cdprep_hull_pair* pair,
                                     cdprep_closest_features* features, cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_CONTACTS_H */
