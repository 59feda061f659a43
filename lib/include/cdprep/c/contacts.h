/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_CONTACTS_H
#define CDPREP_C_CONTACTS_H

#include "cdprep/c/pairs.h"

/* Contacts between convex pieces of two surfaces, and questions about convex hulls. */

enum { CDPREP_VERTEX = 0, CDPREP_EDGE = 1, CDPREP_FACE = 2 };

/* A vertex, edge or face, in numbers of the imported file; CDPREP_NONE where nothing is known. */
typedef struct cdprep_feature {
    uint32_t kind;      /* CDPREP_VERTEX, _EDGE, _FACE */
    uint32_t edge;      /* of the triangle: from this corner to the next */
    uint32_t triangle;  /* one with the vertex or edge, or around the point */
    uint32_t vertex[3]; /* the vertex, ends of the edge, corners of a triangle of the face */
} cdprep_feature;

typedef struct cdprep_contact_point {
    double on_a[3], on_b[3];
    double distance; /* from on_a to on_b along the normal; negative: overlap */
} cdprep_contact_point;

/* Bits of cdprep_contact.flags. */
enum {
    CDPREP_CONTACT_OVERLAP = 1,       /* the hulls of the pieces have a common point */
    CDPREP_CONTACT_INTERNAL_EDGE = 2, /* near an edge inside a surface: the normal is a face's */
    /* the contact is on the inner side of a surface; ignore it for contact response */
    CDPREP_CONTACT_FROM_BEHIND = 4
};

/* How two convex pieces touch, or nearly do. Points are in the frame that the models move to. */
typedef struct cdprep_contact {
    uint32_t piece_a, piece_b;
    cdprep_feature feature_a, feature_b; /* of an edge or face, vertex[0] alone is known */
    uint32_t flags;
    uint32_t point_count; /* in `points`; 0 without a manifold */
    double on_a[3], on_b[3];
    double normal[3];               /* from A to B, of length 1 up to rounding */
    double lower, upper;            /* the exact distance lies between; negative: overlap */
    cdprep_contact_point points[4]; /* the deepest first */
} cdprep_contact;

typedef struct cdprep_contact_list {
    cdprep_contact* items;
    size_t room;       /* given */
    size_t count;      /* answered: contacts, at most cdprep_contact_options.most */
    uint32_t complete; /* answered: CDPREP_NO where `most` or `work` left some out */
    uint32_t reserved; /* 0 */
} cdprep_contact_list;

typedef struct cdprep_contact_options {
    cdprep_head head;
    double tolerance;  /* 0: pieces at most so far apart are in contact */
    uint32_t manifold; /* 0; 4: contacts come with up to four points */
    uint32_t most;     /* 256: contacts of a list, the deepest */
    /* 0: no bound; else: contacts that are computed. The search for near triangles is not
     * bounded. */
    uint64_t work;
} cdprep_contact_options;

typedef int (*cdprep_contact_visitor)(void* context, const cdprep_contact* contact);

CDPREP_API void cdprep_contact_options_init(cdprep_contact_options* options, size_t size);

/* Contacts of two surfaces: one for each pair of convex pieces that have triangles at most
 * `tolerance` apart, exactly as cdprep_pairs_within() says. The list is sorted by `lower`, the
 * deepest first, then by piece_a and piece_b; too little room keeps the deepest. Pairs of pieces
 * are looked at in the order of (piece_a, piece_b), so a bound of `work` leaves out the last.
 * `options` may be null. Uses degenerate; through: CDPREP_THROUGH_BVH, CDPREP_THROUGH_PIECES.
 * Costs 5 to 9 microseconds a pair of pieces besides cdprep_pairs_within(), and O(log room).
 * Needs: CDPREP_ASK_CONTACTS */
CDPREP_API int cdprep_contacts(const cdprep_pair* pair, const cdprep_contact_options* options,
                               cdprep_workspace* workspace, cdprep_contact_list* list,
                               cdprep_error* error);

/* Calls `visit` with all contacts in the order of (piece_a, piece_b). `most` has no meaning: the
 * visitor ends the search.
 * Needs: CDPREP_ASK_CONTACTS */
CDPREP_API int cdprep_contacts_visit(const cdprep_pair* pair, const cdprep_contact_options* options,
                                     cdprep_workspace* workspace, cdprep_contact_visitor visit,
                                     void* context, cdprep_error* error);

/* --- Convex hulls: solid, and asked without a workspace -------------------------------------- */

enum {
    CDPREP_HULL_WHOLE = 0,     /* around the whole model; number 0 */
    CDPREP_HULL_COMPONENT = 1, /* around a connected component */
    CDPREP_HULL_INSTANCE = 2,  /* around an instance of the imported file */
    CDPREP_HULL_PART = 3,      /* one of those that together enclose the model */
    CDPREP_HULL_PIECE = 4      /* of a convex piece, as contacts number them */
};

/* One convex hull of a model, alive as long as that. */
typedef struct cdprep_hull {
    const cdprep_model* model; /* null: no hull */
    uint32_t scope, number;
} cdprep_hull;

/* Finds a hull. A number that has none gives a hull whose model is null, and CDPREP_OK. On failure
 * likewise.
 * Needs: CDPREP_ASK_HULLS; CDPREP_HULL_PIECE: CDPREP_ASK_PIECES, CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_hull_find(const cdprep_model* model, uint32_t scope, uint32_t number,
                                cdprep_hull* hull, cdprep_error* error);

/* Stores corners and facets of a hull, as cdprep_model_mesh(). A flat hull has both sides; a
 * segment and a point have no triangles.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hull_mesh(const cdprep_hull* hull, cdprep_mesh* mesh, cdprep_error* error);

/* Where the last question about one pair of hulls ended. All zero is a new one; any content is
 * safe. Yes and no do not depend on it; of equally near points another may answer. */
typedef struct cdprep_hull_cache {
    uint64_t words[8];
} cdprep_hull_cache;

/* Two hulls and how they are placed: as cdprep_pair. */
typedef struct cdprep_hull_pair {
    cdprep_head head;
    cdprep_hull a, b;
    cdprep_hull_cache* cache;   /* null */
    uint32_t moving;            /* CDPREP_MOVE_B */
    uint32_t reserved;          /* 0 */
    cdprep_pose pose_a, pose_b; /* identity */
} cdprep_hull_pair;

CDPREP_API void cdprep_hull_pair_init(cdprep_hull_pair* pair, size_t size);

/* Whether two hulls have a common point; touching counts. Exact.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hulls_collide(const cdprep_hull_pair* pair, uint32_t* hit,
                                    cdprep_error* error);

/* How far two hulls are apart; 0 where they have a common point. Without permitted errors the
 * interval is at most 1e-12 of upper plus 1e-14 of the size of both wide. `options` may be null.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hulls_distance(const cdprep_hull_pair* pair,
                                     const cdprep_distance_options* options,
                                     cdprep_nearest* nearest, cdprep_error* error);

/* Whether two hulls are at most `tolerance` apart, 0 or more. Exact to the last bit.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hulls_within(const cdprep_hull_pair* pair, double tolerance, uint32_t* within,
                                   cdprep_error* error);

typedef struct cdprep_penetration {
    uint32_t found;          /* CDPREP_NO: they have no common point; then the rest is 0 */
    uint32_t reserved;       /* 0 */
    double lower, upper;     /* the penetration depth lies between, model units */
    double normal[3];        /* the direction in which B is moved, of length 1 up to rounding */
    double on_a[3], on_b[3]; /* what then touches */
} cdprep_penetration;

/* How deep two hulls are in each other. `options` may be null; max_distance has no meaning.
 * Costs ten to a hundred distances.
 * Needs: as cdprep_hull_find() */
CDPREP_API int cdprep_hulls_penetration(const cdprep_hull_pair* pair,
                                        const cdprep_distance_options* options,
                                        cdprep_penetration* penetration, cdprep_error* error);

typedef struct cdprep_closest_features {
    uint32_t found;      /* CDPREP_NO: they have a common point; then the rest is 0 */
    uint32_t parallel;   /* CDPREP_YES: other points may be as near */
    cdprep_feature a, b; /* of the hulls: kind and vertices, which the imported file numbers */
    double lower, upper; /* as of a distance */
    double on_a[3], on_b[3];
} cdprep_closest_features;

/* The nearest features of two hulls of convex pieces, which alone have them: other scopes have no
 * meaning. With a cache O(1) where little has moved.
 * Needs: CDPREP_ASK_CONTACTS */
CDPREP_API int cdprep_hulls_features(const cdprep_hull_pair* pair,
                                     cdprep_closest_features* features, cdprep_error* error);

#endif /* CDPREP_C_CONTACTS_H */
