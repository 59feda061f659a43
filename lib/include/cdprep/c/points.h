/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_POINTS_H
#define CDPREP_C_POINTS_H

#include "cdprep/c/pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Queries about one model: points, rays and shapes. The lanes of the workspace share the work on
 * many points or rays. The answers are those of one lane, in the order of the points or rays. */

/* --- Points --------------------------------------------------------------------------------- */

typedef struct cdprep_point_query {
    cdprep_head head;
    const cdprep_model* model;
    const double* points; /* null: 3 numbers per point, model coordinates */
    size_t count;         /* 1 */
    double max_distance;  /* infinity; only cdprep_points_closest() uses it */
    uint32_t through;     /* CDPREP_THROUGH_BVH; only cdprep_points_inside() uses it */
    uint32_t reserved;    /* 0 */
} cdprep_point_query;

CDPREP_API void cdprep_point_query_init(cdprep_point_query* query, size_t size);

typedef struct cdprep_closest_point {
    uint32_t found;      /* CDPREP_NO: nothing within max_distance; then the rest is 0 */
    uint32_t triangle;   /* the one with the point; among equally near ones the lowest number */
    double point[3];     /* up to rounding */
    double lower, upper; /* bounds of the exact distance, model units */
} cdprep_closest_point;

/* Stores the points of a model's surface that are nearest to `count` points. `answers` must have
 * room for `count` results. The distance is to the surface, also for a point inside a solid. Takes
 * O(log n) time for most points.
 * Needs: CDPREP_ASK_CLOSEST */
CDPREP_API int cdprep_points_closest(const cdprep_point_query* query, cdprep_workspace* workspace,
                                     cdprep_closest_point* answers, cdprep_error* error);

typedef struct cdprep_point_state {
    uint32_t inside;     /* CDPREP_NO, _YES; _UNKNOWN within the box of an unbalanced model */
    uint32_t on_surface; /* CDPREP_YES: on a triangle; then inside is CDPREP_YES */
    double winding;      /* the winding number; 0 on the surface */
} cdprep_point_state;

/* Stores whether `count` points are inside a model, that is, whether their winding numbers are not
 * 0. Exact for balanced models (cdprep_model_info.balanced). `through` may be any structure except
 * CDPREP_THROUGH_PIECES. For octrees and tetra-trees, the workspace must have `cells`, and the
 * model must serve the structure's CDPREP_ASK_ bit. Through the BVH, takes O(log n + ray hits) time
 * per point. Takes O(n) time for a point in the box of an unbalanced model.
 * Needs: CDPREP_ASK_INSIDE */
CDPREP_API int cdprep_points_inside(const cdprep_point_query* query, cdprep_workspace* workspace,
                                    cdprep_point_state* answers, cdprep_error* error);

/* --- Rays ----------------------------------------------------------------------------------- */

typedef struct cdprep_ray {
    double origin[3];    /* model coordinates */
    double direction[3]; /* any length but 0; one so short that t could overflow is refused */
    double max_t;        /* 0 or more, in lengths of the direction; INFINITY for the whole ray */
} cdprep_ray;

typedef struct cdprep_ray_query {
    cdprep_head head;
    const cdprep_model* model;
    const cdprep_ray* rays;
    size_t count; /* 1 */
} cdprep_ray_query;

CDPREP_API void cdprep_ray_query_init(cdprep_ray_query* query, size_t size);

typedef struct cdprep_ray_hit {
    uint32_t found;    /* CDPREP_NO: no hit; then the rest is 0 */
    uint32_t triangle; /* among hits with equal t the lowest number */
    double t;          /* in lengths of the direction, rounded */
    double point[3];   /* origin + t * direction, rounded */
} cdprep_ray_hit;

typedef struct cdprep_ray_hit_list {
    cdprep_ray_hit* items;
    size_t room, count;
} cdprep_ray_hit_list;

/* Receives each hit and the caller's context; returning 0 ends the search. */
typedef int (*cdprep_ray_visitor)(void* context, const cdprep_ray_hit* hit);

/* Stores the first hit of each ray; `hits` must have room for `count` results. Each hit is decided
 * exactly. A triangle includes its edges and vertices, so no ray passes between two triangles that
 * share an edge. Both sides of a triangle count. A ray in the plane of a triangle hits at the point
 * where the ray enters the triangle. t is rounded, and within 2^-40 of its exact value, relative to
 * it. So either of two hits with nearly equal t may be the first. A hit near max_t may be accepted
 * or rejected. Takes O(log n) time for most rays.
 * Needs: CDPREP_ASK_RAY */
CDPREP_API int cdprep_rays_cast(const cdprep_ray_query* query, cdprep_workspace* workspace,
                                cdprep_ray_hit* hits, cdprep_error* error);

/* Stores whether each ray hits anything: CDPREP_YES or CDPREP_NO. Stops at the first hit found.
 * Needs: CDPREP_ASK_RAY */
CDPREP_API int cdprep_rays_any(const cdprep_ray_query* query, cdprep_workspace* workspace,
                               uint32_t* hits, cdprep_error* error);

/* Lists all hits of each ray, sorted by t, then by triangle, each triangle once. Each ray has its
 * own list.
 * Needs: CDPREP_ASK_RAY */
CDPREP_API int cdprep_rays_all(const cdprep_ray_query* query, cdprep_workspace* workspace,
                               cdprep_ray_hit_list* lists, cdprep_error* error);

/* Calls `visit` with each hit of one ray, in no particular order. `count` must be 1, because a hit
 * does not name its ray. Returns CDPREP_OK even if the visitor ended the search.
 * Needs: CDPREP_ASK_RAY */
CDPREP_API int cdprep_rays_visit(const cdprep_ray_query* query, cdprep_workspace* workspace,
                                 cdprep_ray_visitor visit, void* context, cdprep_error* error);

/* --- Shapes --------------------------------------------------------------------------------- */

enum {
    CDPREP_BOX = 1,     /* limits a and b, a <= b; a may be -infinity, b may be infinity */
    CDPREP_SPHERE = 2,  /* centre a, radius */
    CDPREP_CAPSULE = 3, /* ends a and b, radius; radius 0 is the segment */
    CDPREP_TRIANGLE = 4 /* corners a, b, c */
};

/* A closed, solid shape, and the placement of the model. A negative radius is refused. Of a, b, c
 * and radius, those that the shape does not use are ignored. */
typedef struct cdprep_shape_query {
    cdprep_head head;
    const cdprep_model* model;
    uint32_t shape;                  /* 0, which is refused: choose one */
    uint32_t degenerate;             /* CDPREP_KEEP_DEGENERATE */
    double a[3], b[3], c[3], radius; /* 0 */
    double max_distance;             /* infinity; only cdprep_shape_distance() uses it */
    cdprep_pose world_from_model;    /* identity: shapes are in the model's coordinates */
} cdprep_shape_query;

CDPREP_API void cdprep_shape_query_init(cdprep_shape_query* query, size_t size);

typedef struct cdprep_triangle_list {
    uint32_t* items;
    size_t room, count;
} cdprep_triangle_list;

/* Receives each triangle and the caller's context; returning 0 ends the search. */
typedef int (*cdprep_triangle_visitor)(void* context, uint32_t triangle);

/* Stores whether a shape has a point in common with a triangle of the model. Exact, also for
 * tangent shapes. A model is its surface: a shape deep inside touches nothing. Takes O(log n) time
 * for most shapes.
 * Needs: CDPREP_ASK_TOUCH */
CDPREP_API int cdprep_touch(const cdprep_shape_query* query, cdprep_workspace* workspace,
                            uint32_t* touches, cdprep_error* error);

/* Lists all triangles that the shape touches, sorted. If there is too little room, the list keeps
 * the smallest numbers.
 * Needs: CDPREP_ASK_TOUCH */
CDPREP_API int cdprep_touch_list(const cdprep_shape_query* query, cdprep_workspace* workspace,
                                 cdprep_triangle_list* list, cdprep_error* error);

/* Calls `visit` with each triangle that the shape touches, in no particular order. Returns
 * CDPREP_OK even if the visitor ended the search.
 * Needs: CDPREP_ASK_TOUCH */
CDPREP_API int cdprep_touch_visit(const cdprep_shape_query* query, cdprep_workspace* workspace,
                                  cdprep_triangle_visitor visit, void* context,
                                  cdprep_error* error);

/* Stores the distance of a shape from the surface. `degenerate` must keep its default. In the
 * answer, the model is A and the shape is B. For a sphere, on_b is its centre; for a capsule, on_b
 * is on its segment. If there is a result, triangle_b is CDPREP_NONE.
 * Needs: CDPREP_ASK_TOUCH */
CDPREP_API int cdprep_shape_distance(const cdprep_shape_query* query, cdprep_workspace* workspace,
                                     cdprep_nearest* nearest, cdprep_error* error);

/* Both functions run `count` queries on the lanes of the workspace, about one model or several.
 * Element i of the answers is that of cdprep_touch() or cdprep_shape_distance() for queries[i]. All
 * queries are checked first. If one is invalid, none runs, and error.argument names it
 * ("queries[3].radius"). The size in the head of the first query is the stride of the array. With
 * several lanes, a batch of about ten queries or more is faster than single calls.
 * Needs: CDPREP_ASK_TOUCH */
CDPREP_API int cdprep_touch_many(const cdprep_shape_query* queries, size_t count,
                                 cdprep_workspace* workspace, uint32_t* touches,
                                 cdprep_error* error);
CDPREP_API int cdprep_shape_distance_many(const cdprep_shape_query* queries, size_t count,
                                          cdprep_workspace* workspace, cdprep_nearest* nearest,
                                          cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_POINTS_H */
