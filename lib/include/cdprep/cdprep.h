/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_CDPREP_H
#define CDPREP_CDPREP_H

#include <stddef.h>
#include <stdint.h>

/* The C face: every question of the C++ headers, for C99 and for languages that
 * call C. What a question means, costs and needs stands in the header of the same
 * name: collide.h, overlapping_triangles.h, distance.h, triangles_within.h,
 * cast_ray.h, closest_point.h, containment.h, touching_box.h, touching_sphere.h,
 * touching_capsule.h, touching_triangle.h; convex_distance.h, convex_penetration.h and
 * model_hulls.h for convex hulls; contacts.h and closest_features.h for convex pieces;
 * batch.h and split_overlap.h for many questions at once and for one on many threads.
 *
 * Every function returns CDPREP_OK or a code, and then fills `error`, which may be
 * null. No exception leaves a function. A struct that may grow starts with its
 * size, which the caller sets to sizeof: older programs keep working with newer
 * libraries. Null stands for default options.
 *
 * Models are read-only and may serve any number of threads; a workspace serves one
 * question at a time. */

#ifdef __cplusplus
extern "C" {
#endif

/* Codes; numbers are never reused. */
enum {
    CDPREP_OK = 0,
    CDPREP_BAD_ARGUMENT = 1, /* asked wrongly: a null, a size, a pose that is none */
    CDPREP_UNREADABLE = 2,   /* a file that is missing, malformed or damaged */
    CDPREP_OVER_BUDGET = 4,  /* no memory */
    CDPREP_INTERNAL = 5      /* our own mistake */
};

/* Why something could not be done: a whole sentence for a person, cut to fit. */
typedef struct cdprep_error {
    int code;
    char message[508]; /* ends with a zero */
} cdprep_error;

typedef struct cdprep_model cdprep_model;
typedef struct cdprep_workspace cdprep_workspace;

/* --- Models ----------------------------------------------------------------- */

/* Maps a baked file and checks all of it. Close with cdprep_close(). */
int cdprep_open(const char* path, cdprep_model** model, cdprep_error* error);

/* The same for bytes in memory, which start at a multiple of 64 and outlive the
 * model; `name` is for messages. */
int cdprep_open_memory(const void* bytes, size_t size, const char* name, cdprep_model** model,
                       cdprep_error* error);

/* Checks the header alone: for bytes that the caller trusts. */
int cdprep_open_trusted(const char* path, cdprep_model** model, cdprep_error* error);

void cdprep_close(cdprep_model* model); /* null does nothing */

uint32_t cdprep_triangle_count(const cdprep_model* model);
uint32_t cdprep_vertex_count(const cdprep_model* model);
int cdprep_is_closed(const cdprep_model* model);

/* Bits of cdprep_verdict.promises; cdprep/format/verdict.h says what they and those of
 * `facts` mean. */
enum {
    CDPREP_PROMISE_SURFACE = 1,
    CDPREP_PROMISE_INSIDE_EXACT = 2,
    CDPREP_PROMISE_SIMPLE_SOLID = 4,
    CDPREP_PROMISE_CONTAINED_PIECES = 8
};

/* What was found of a mesh when it was baked, and what answers mean on it. */
typedef struct cdprep_verdict {
    uint32_t facts;
    uint32_t promises;
    uint32_t triangle_count;
    uint32_t first_triangle; /* the lowest, source numbering */
    uint32_t boundary_loops;
    int32_t euler;
    int32_t genus; /* -1: none */
    uint32_t reserved;
    double area;   /* square model units */
    double volume; /* cubic model units, signed; 0 unless balanced */
} cdprep_verdict;

/* How many verdicts a model has: number 0 is of the whole mesh, the others of its
 * components. 0 when the file has none. */
size_t cdprep_verdict_count(const cdprep_model* model);

/* Returns 0, and stores nothing, when there is none of this number. */
int cdprep_read_verdict(const cdprep_model* model, size_t number, cdprep_verdict* verdict);

/* By source triangle, what it was in the file before it was repaired, or UINT32_MAX; null
 * when nothing was repaired. Lives as long as the model. */
const uint32_t* cdprep_repaired_from(const cdprep_model* model);

/* --- Scratch ------------------------------------------------------------------ */

/* Bytes that a workspace takes, and what their address must be a multiple of. */
size_t cdprep_workspace_size(void);
size_t cdprep_workspace_alignment(void);

/* Makes a workspace in the caller's memory, or returns null when that is null, too
 * small or not aligned. Nothing to free: it ends with the memory. */
cdprep_workspace* cdprep_make_workspace(void* memory, size_t size);

/* Several in one piece of memory, for questions on several threads; the same alignment,
 * and the same when it cannot be. The size of too many is SIZE_MAX. */
typedef struct cdprep_workspaces cdprep_workspaces;

size_t cdprep_workspaces_size(size_t count);
cdprep_workspaces* cdprep_make_workspaces(void* memory, size_t size, size_t count);

/* --- Placement ------------------------------------------------------------------ */

enum {
    CDPREP_B_MOVES = 0,  /* `b` is a_from_b; A stays */
    CDPREP_A_MOVES = 1,  /* `a` is b_from_a; B stays */
    CDPREP_RELATIVE = 2, /* two world poses; B moves by the relative one */
    CDPREP_WORLD = 3     /* two world poses; both move */
};

/* R row by row, then T; model units. |R^T R - I| at most 1e-12, no mirror. */
typedef struct cdprep_pose {
    double rows[12];
} cdprep_pose;

typedef struct cdprep_placement {
    uint32_t size;
    uint32_t kind;
    cdprep_pose a; /* read when the kind says so */
    cdprep_pose b;
} cdprep_placement;

/* --- Two models ------------------------------------------------------------------ */

enum { CDPREP_CLOSED = 0, CDPREP_PROPER = 1 };
enum { CDPREP_KEEP_DEGENERATE = 0, CDPREP_SKIP_DEGENERATE = 1 };
enum { CDPREP_SURFACE = 0, CDPREP_SOLID = 1 };
enum { CDPREP_NO = 0, CDPREP_YES = 1, CDPREP_UNKNOWN = 2 };

typedef struct cdprep_contact_options {
    uint32_t size;
    uint32_t contact;    /* CDPREP_CLOSED */
    uint32_t degenerate; /* CDPREP_KEEP_DEGENERATE */
    uint32_t as;         /* CDPREP_SURFACE; cdprep_collide() alone reads it */
} cdprep_contact_options;

typedef struct cdprep_collision {
    int hit;
    int containment; /* CDPREP_NO, _YES, _UNKNOWN; solids alone */
    int a_inside_b;
    double winding;
} cdprep_collision;

/* What earlier questions about one pair of models found: see pair_cache.h. All zero
 * before the first use; one a pair and thread. */
typedef struct cdprep_pair_cache {
    uint64_t words[26];
} cdprep_pair_cache;

/* `cache` may be null. */
int cdprep_collide(const cdprep_model* a, const cdprep_model* b, const cdprep_placement* placement,
                   cdprep_workspace* workspace, const cdprep_contact_options* options,
                   cdprep_pair_cache* cache, cdprep_collision* collision, cdprep_error* error);

typedef struct cdprep_containment {
    int answer; /* CDPREP_NO, _YES, _UNKNOWN */
    int a_inside_b;
    double winding;
} cdprep_containment;

/* For two models whose surfaces do not touch. */
int cdprep_find_containment(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            cdprep_containment* containment, cdprep_error* error);

typedef struct cdprep_triangle_pair {
    uint32_t a;
    uint32_t b;
} cdprep_triangle_pair;

/* Writes at most `room` pairs, the smallest, sorted; `count` is how many there are.
 * `pairs` may be null when `room` is 0, and `cache` always. */
int cdprep_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                 const cdprep_placement* placement, cdprep_workspace* workspace,
                                 const cdprep_contact_options* options, cdprep_pair_cache* cache,
                                 cdprep_triangle_pair* pairs, size_t room, size_t* count,
                                 cdprep_error* error);

/* Called with every answer as it is found, and with the caller's `context`; 0 ends the
 * search. Like everything that the caller hands over to be called, it returns: by no
 * exception and no longjmp(). */
typedef int (*cdprep_pair_visitor)(void* context, const cdprep_triangle_pair* pair);

int cdprep_visit_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                       const cdprep_placement* placement,
                                       cdprep_workspace* workspace,
                                       const cdprep_contact_options* options,
                                       cdprep_pair_cache* cache, cdprep_pair_visitor visit,
                                       void* context, cdprep_error* error);

/* Sets bit i % 64 of element i / 64 for each triangle i that overlaps any of the other
 * model, and clears all others; an array with fewer than a word for every 64 triangles
 * is only cleared, and may be null when it has none. `count` is the number of pairs. */
int cdprep_mark_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                      const cdprep_placement* placement,
                                      cdprep_workspace* workspace,
                                      const cdprep_contact_options* options,
                                      cdprep_pair_cache* cache, uint64_t* bits_a, size_t words_a,
                                      uint64_t* bits_b, size_t words_b, size_t* count,
                                      cdprep_error* error);

/* A pair of triangles in contact and the segment that they share: see
 * crossing_segments.h. */
typedef struct cdprep_crossing {
    cdprep_triangle_pair pair;
    int is_flat;    /* they may share an area; the ends are 0 */
    double from[3]; /* equal ends where they touch in a point */
    double to[3];
} cdprep_crossing;

/* Writes at most `room` crossings, in no particular order; `count` is how many there
 * are. `crossings` may be null when `room` is 0. */
int cdprep_crossing_segments(const cdprep_model* a, const cdprep_model* b,
                             const cdprep_placement* placement, cdprep_workspace* workspace,
                             const cdprep_contact_options* options, cdprep_crossing* crossings,
                             size_t room, size_t* count, cdprep_error* error);

typedef int (*cdprep_crossing_visitor)(void* context, const cdprep_crossing* crossing);

int cdprep_visit_crossing_segments(const cdprep_model* a, const cdprep_model* b,
                                   const cdprep_placement* placement, cdprep_workspace* workspace,
                                   const cdprep_contact_options* options,
                                   cdprep_crossing_visitor visit, void* context,
                                   cdprep_error* error);

typedef struct cdprep_distance_options {
    uint32_t size;
    uint32_t as; /* CDPREP_SURFACE */
    double relative_error;
    double absolute_error;
    double max_distance; /* inclusive; HUGE_VAL for none */
} cdprep_distance_options;

typedef struct cdprep_distance {
    double lower;
    double upper;
    double witness_a[3];
    double witness_b[3];
    uint32_t triangle_a;
    uint32_t triangle_b;
} cdprep_distance;

/* `found` is 0 when nothing is within max_distance. `cache` may be null. */
int cdprep_distance_between(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            const cdprep_distance_options* options, cdprep_pair_cache* cache,
                            int* found, cdprep_distance* distance, cdprep_error* error);

int cdprep_is_within(const cdprep_model* a, const cdprep_model* b,
                     const cdprep_placement* placement, cdprep_workspace* workspace,
                     double tolerance, cdprep_pair_cache* cache, int* within, cdprep_error* error);

/* Writes at most `room` pairs, the smallest, sorted; `count` is how many are within the
 * tolerance. Of the options `degenerate` alone is read. `pairs` may be null when `room`
 * is 0. */
int cdprep_triangles_within(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            double tolerance, const cdprep_contact_options* options,
                            cdprep_triangle_pair* pairs, size_t room, size_t* count,
                            cdprep_error* error);

/* --- Two convex hulls ------------------------------------------------------------- */

enum {
    CDPREP_HULL_WHOLE = 0,
    CDPREP_HULL_COMPONENT = 1,
    CDPREP_HULL_INSTANCE = 2,
    CDPREP_HULL_PART = 3
};

/* One convex hull of a baked model; lives as long as that. */
typedef struct cdprep_hull {
    const cdprep_model* model;
    uint32_t number; /* of the hull, as cdprep_find_hull() stores it */
} cdprep_hull;

/* The hull around the whole model, or around the component, instance or part of a number, which
 * is 0 for the whole. `found` is 0, and `hull` is of no use, when none was baked. */
int cdprep_find_hull(const cdprep_model* model, uint32_t scope, uint32_t number, int* found,
                     cdprep_hull* hull, cdprep_error* error);

/* Where the last question about two hulls ended: see convex_distance.h. All zero before
 * the first use; one a pair and thread. */
typedef struct cdprep_convex_cache {
    uint32_t words[9];
} cdprep_convex_cache;

/* The hulls are solid, and no workspace is needed. `cache` may be null, here and below. */
int cdprep_hulls_collide(const cdprep_hull* a, const cdprep_hull* b,
                         const cdprep_placement* placement, cdprep_convex_cache* cache, int* hit,
                         cdprep_error* error);

/* Of the options those that are about errors and max_distance are read; `as` is not. Stores
 * no triangles: UINT32_MAX. `found` is 0 when nothing is within max_distance. */
int cdprep_hull_distance(const cdprep_hull* a, const cdprep_hull* b,
                         const cdprep_placement* placement, const cdprep_distance_options* options,
                         cdprep_convex_cache* cache, int* found, cdprep_distance* distance,
                         cdprep_error* error);

int cdprep_hulls_within(const cdprep_hull* a, const cdprep_hull* b,
                        const cdprep_placement* placement, double tolerance,
                        cdprep_convex_cache* cache, int* within, cdprep_error* error);

/* How deep two hulls are in each other: see convex_penetration.h. */
typedef struct cdprep_penetration {
    double lower;
    double upper;
    double normal[3]; /* the way that B goes */
    double witness_a[3];
    double witness_b[3];
} cdprep_penetration;

/* `found` is 0 when they have no common point. Of the options the two errors alone are
 * read. */
int cdprep_hull_penetration(const cdprep_hull* a, const cdprep_hull* b,
                            const cdprep_placement* placement,
                            const cdprep_distance_options* options, cdprep_convex_cache* cache,
                            int* found, cdprep_penetration* penetration, cdprep_error* error);

/* --- Convex pieces of two models -------------------------------------------------- */

/* Of models baked with the effect contacts; others have no contacts and no pieces. */

enum { CDPREP_VERTEX = 0, CDPREP_EDGE = 1, CDPREP_FACE = 2 };

/* Where on the imported mesh a contact is, in its numbering. */
typedef struct cdprep_contact_feature {
    uint32_t kind;     /* CDPREP_VERTEX, _EDGE, _FACE */
    uint32_t edge;     /* of the triangle: from this corner to the next; 0 for other kinds */
    uint32_t triangle; /* one with the vertex or edge, or around the point */
    uint32_t vertex;   /* the vertex; of an edge its first; of a face its first corner */
} cdprep_contact_feature;

typedef struct cdprep_manifold_point {
    double on_a[3];
    double on_b[3];
    double distance; /* negative: overlap */
} cdprep_manifold_point;

/* Bits of cdprep_piece_contact.flags. */
enum {
    CDPREP_CONTACT_OVERLAP = 1,
    CDPREP_CONTACT_INTERNAL_EDGE = 2,
    CDPREP_CONTACT_FROM_BEHIND = 4
};

enum { CDPREP_MOST_MANIFOLD_POINTS = 4 };

/* How two convex pieces touch, or nearly do: see contacts.h. */
typedef struct cdprep_piece_contact {
    uint32_t piece_a;
    uint32_t piece_b;
    cdprep_contact_feature feature_a;
    cdprep_contact_feature feature_b;
    double point_a[3];
    double point_b[3];
    double normal[3]; /* from A to B */
    double lower;     /* negative where the hulls of the pieces overlap */
    double upper;
    uint32_t flags;
    uint32_t point_count; /* of `points`; 0 where no manifold was asked for */
    cdprep_manifold_point points[CDPREP_MOST_MANIFOLD_POINTS]; /* the deepest first */
} cdprep_piece_contact;

enum { CDPREP_NO_MANIFOLD = 0, CDPREP_FOUR_POINTS = 1 };

typedef struct cdprep_piece_contact_options {
    uint32_t size;
    uint32_t manifold;   /* CDPREP_NO_MANIFOLD */
    uint32_t degenerate; /* CDPREP_KEEP_DEGENERATE */
} cdprep_piece_contact_options;

/* Writes at most `room` contacts, the first in the order of (piece_a, piece_b); `count` is how
 * many there are. `contacts` may be null when `room` is 0. */
int cdprep_contacts(const cdprep_model* a, const cdprep_model* b, const cdprep_placement* placement,
                    cdprep_workspace* workspace, double tolerance,
                    const cdprep_piece_contact_options* options, cdprep_piece_contact* contacts,
                    size_t room, size_t* count, cdprep_error* error);

typedef int (*cdprep_piece_contact_visitor)(void* context, const cdprep_piece_contact* contact);

int cdprep_visit_contacts(const cdprep_model* a, const cdprep_model* b,
                          const cdprep_placement* placement, cdprep_workspace* workspace,
                          double tolerance, const cdprep_piece_contact_options* options,
                          cdprep_piece_contact_visitor visit, void* context, cdprep_error* error);

/* One piece of a model, by its number as contacts name it: below cdprep_piece_count(). */
typedef struct cdprep_piece {
    const cdprep_model* model;
    uint32_t number;
} cdprep_piece;

size_t cdprep_piece_count(const cdprep_model* model);

/* A part of a piece's hull, by vertices of the imported mesh: one, or the two that an edge runs
 * between, or of a face the corners of a triangle in its plane; UINT32_MAX past them. */
typedef struct cdprep_hull_feature {
    uint32_t kind; /* CDPREP_VERTEX, _EDGE, _FACE */
    uint32_t vertex[3];
} cdprep_hull_feature;

typedef struct cdprep_closest_features {
    cdprep_hull_feature a;
    cdprep_hull_feature b;
    double lower;
    double upper;
    double witness_a[3];
    double witness_b[3];
    int parallel; /* other points may be as near */
} cdprep_closest_features;

/* Where the last question about two pieces ended: see closest_features.h. All zero before
 * the first use; one a pair and thread. */
typedef struct cdprep_feature_cache {
    uint32_t words[5];
} cdprep_feature_cache;

/* The nearest features of the hulls of two pieces, which are solid; no workspace is needed.
 * `found` is 0 when they have a common point. `cache` may be null. */
int cdprep_find_closest_features(const cdprep_piece* a, const cdprep_piece* b,
                                 const cdprep_placement* placement, cdprep_feature_cache* cache,
                                 int* found, cdprep_closest_features* features,
                                 cdprep_error* error);

/* --- One model ------------------------------------------------------------------ */

typedef struct cdprep_ray_hit {
    double t;
    double point[3];
    uint32_t triangle;
} cdprep_ray_hit;

int cdprep_cast_ray(const cdprep_model* model, const double origin[3], const double direction[3],
                    double max_t, cdprep_workspace* workspace, int* found, cdprep_ray_hit* hit,
                    cdprep_error* error);

int cdprep_ray_hits(const cdprep_model* model, const double origin[3], const double direction[3],
                    double max_t, cdprep_workspace* workspace, int* hits, cdprep_error* error);

/* Writes at most `room` hits, the first, in order; `count` is how many there are.
 * `hits` may be null when `room` is 0. */
int cdprep_all_ray_hits(const cdprep_model* model, const double origin[3],
                        const double direction[3], double max_t, cdprep_workspace* workspace,
                        cdprep_ray_hit* hits, size_t room, size_t* count, cdprep_error* error);

typedef int (*cdprep_ray_visitor)(void* context, const cdprep_ray_hit* hit);

int cdprep_visit_ray_hits(const cdprep_model* model, const double origin[3],
                          const double direction[3], double max_t, cdprep_workspace* workspace,
                          cdprep_ray_visitor visit, void* context, cdprep_error* error);

typedef struct cdprep_closest_point {
    double point[3];
    double lower;
    double upper;
    uint32_t triangle;
} cdprep_closest_point;

int cdprep_find_closest_point(const cdprep_model* model, const double query[3], double max_distance,
                              cdprep_workspace* workspace, int* found,
                              cdprep_closest_point* closest, cdprep_error* error);

enum {
    CDPREP_BOX = 0,     /* `a` lower, `b` upper limits; may be infinite */
    CDPREP_SPHERE = 1,  /* `a` centre, `radius` */
    CDPREP_CAPSULE = 2, /* `a` and `b` ends, `radius`; 0 is the segment */
    CDPREP_TRIANGLE = 3 /* `a`, `b`, `c` corners */
};

typedef struct cdprep_shape {
    uint32_t size;
    uint32_t kind;
    double a[3]; /* what the kind does not name is not read */
    double b[3];
    double c[3];
    double radius;
} cdprep_shape;

typedef struct cdprep_shape_options {
    uint32_t size;
    uint32_t degenerate;          /* CDPREP_KEEP_DEGENERATE; distances always keep */
    uint32_t is_moved;            /* 0: the shape is in model coordinates */
    cdprep_pose world_from_model; /* read when is_moved is not 0 */
    double max_distance;          /* inclusive, HUGE_VAL for none; distances alone read it */
} cdprep_shape_options;

int cdprep_touches(const cdprep_model* model, const cdprep_shape* shape,
                   cdprep_workspace* workspace, const cdprep_shape_options* options, int* touches,
                   cdprep_error* error);

/* Writes at most `room` triangles, the smallest numbers, sorted; `count` is how many
 * there are. `triangles` may be null when `room` is 0. */
int cdprep_touching_triangles(const cdprep_model* model, const cdprep_shape* shape,
                              cdprep_workspace* workspace, const cdprep_shape_options* options,
                              uint32_t* triangles, size_t room, size_t* count, cdprep_error* error);

typedef int (*cdprep_triangle_visitor)(void* context, uint32_t triangle);

int cdprep_visit_touching_triangles(const cdprep_model* model, const cdprep_shape* shape,
                                    cdprep_workspace* workspace,
                                    const cdprep_shape_options* options,
                                    cdprep_triangle_visitor visit, void* context,
                                    cdprep_error* error);

typedef struct cdprep_shape_distance {
    double lower;
    double upper;
    double on_model[3];
    double on_shape[3];
    uint32_t triangle;
} cdprep_shape_distance;

/* Of a capsule or a triangle; for a sphere, a capsule whose ends are equal. `found` is 0
 * when nothing is within max_distance. */
int cdprep_distance_to(const cdprep_model* model, const cdprep_shape* shape,
                       cdprep_workspace* workspace, const cdprep_shape_options* options, int* found,
                       cdprep_shape_distance* distance, cdprep_error* error);

typedef struct cdprep_inclusion {
    int inside; /* CDPREP_NO, _YES, _UNKNOWN */
    int on_surface;
    double winding;
} cdprep_inclusion;

int cdprep_includes(const cdprep_model* model, const double point[3], cdprep_workspace* workspace,
                    cdprep_inclusion* inclusion, cdprep_error* error);

/* --- On the caller's threads ------------------------------------------------------ */

/* The caller's threads: `run` calls task(work, 0) ... task(work, count - 1), in any
 * order, on any threads, and returns when all are done. See parallel_for.h. */
typedef void (*cdprep_task)(const void* work, size_t number);

typedef struct cdprep_parallel_for {
    uint32_t size;
    void (*run)(void* context, size_t count, cdprep_task task, const void* work);
    void* context; /* handed to `run` */
} cdprep_parallel_for;

/* One question of a batch, as the questions about two models take it. */
typedef struct cdprep_pair_job {
    const cdprep_model* a;
    const cdprep_model* b;
    const cdprep_placement* placement;
    cdprep_pair_cache* cache; /* or null; no two jobs of a batch share one */
} cdprep_pair_job;

/* These ask the question of the same name of `count` jobs and store the answers in their
 * order, the same as one by one. One thread works for each workspace. All jobs are checked
 * first: when one is asked wrongly, the error says which, and none is asked. Without
 * `parallel_for` (null, or a null `run`) they are asked one after the other. */
int cdprep_collide_all(const cdprep_pair_job* jobs, size_t count, cdprep_workspaces* workspaces,
                       const cdprep_parallel_for* parallel_for,
                       const cdprep_contact_options* options, cdprep_collision* collisions,
                       cdprep_error* error);

int cdprep_distance_between_all(const cdprep_pair_job* jobs, size_t count,
                                cdprep_workspaces* workspaces,
                                const cdprep_parallel_for* parallel_for,
                                const cdprep_distance_options* options, int* found,
                                cdprep_distance* distances, cdprep_error* error);

int cdprep_is_within_all(const cdprep_pair_job* jobs, size_t count, cdprep_workspaces* workspaces,
                         const cdprep_parallel_for* parallel_for, double tolerance, int* within,
                         cdprep_error* error);

/* Where one job's pairs go, as cdprep_overlapping_triangles() takes it; only counts where
 * there is no room. */
typedef struct cdprep_overlap_answer {
    cdprep_triangle_pair* pairs;
    size_t room;
    size_t count; /* answered */
} cdprep_overlap_answer;

int cdprep_overlapping_triangles_all(const cdprep_pair_job* jobs, size_t count,
                                     cdprep_workspaces* workspaces,
                                     const cdprep_parallel_for* parallel_for,
                                     const cdprep_contact_options* options,
                                     cdprep_overlap_answer* answers, cdprep_error* error);

/* Where one job's marks go, as cdprep_mark_overlapping_triangles() takes it. */
typedef struct cdprep_marked_triangles {
    uint64_t* bits_a;
    size_t words_a;
    uint64_t* bits_b;
    size_t words_b;
    size_t count; /* answered */
} cdprep_marked_triangles;

int cdprep_mark_overlapping_triangles_all(const cdprep_pair_job* jobs, size_t count,
                                          cdprep_workspaces* workspaces,
                                          const cdprep_parallel_for* parallel_for,
                                          const cdprep_contact_options* options,
                                          cdprep_marked_triangles* answers, cdprep_error* error);

/* cdprep_overlapping_triangles() of one pair of large models, on as many threads as there
 * are workspaces: the same answer. */
int cdprep_split_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                       const cdprep_placement* placement,
                                       cdprep_workspaces* workspaces,
                                       const cdprep_parallel_for* parallel_for,
                                       const cdprep_contact_options* options,
                                       cdprep_triangle_pair* pairs, size_t room, size_t* count,
                                       cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_CDPREP_H */
