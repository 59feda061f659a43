/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_MOTION_H
#define CDPREP_C_MOTION_H

#include "cdprep/c/pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The time at which two moving models first touch, and the space through which a deforming model
 * passes. */

/* The form in which a motion is given. */
enum {
    CDPREP_MOTION_POSES = 0,   /* `start` and `end`; the model turns the shorter way between them */
    CDPREP_MOTION_VELOCITY = 1 /* `start`, `shift` and `turn` */
};

/* The rigid motion of a model during a step, from time 0 to time 1. One point of the model, the
 * centre, moves along a straight line at constant speed. The model turns about the centre, on a
 * fixed axis, at constant speed. A good centre for a free body is its centre of mass. For a part
 * that turns about a joint, it is the joint. A centre far outside the model makes the query slow.
 * cdprep_moving_pair_init() makes motions that stay at the identity; then set their fields. */
typedef struct cdprep_motion {
    cdprep_pose start;
    cdprep_pose end;  /* used only by CDPREP_MOTION_POSES; otherwise the identity */
    double centre[3]; /* in the model's coordinates; 0 */
    double shift[3];  /* the path of the centre; used only by CDPREP_MOTION_VELOCITY; otherwise 0 */
    /* Along the axis, in world coordinates. Its length is the angle in radians, at most 1000. Used
     * only by CDPREP_MOTION_VELOCITY; otherwise 0. */
    double turn[3];
    uint32_t given_by; /* CDPREP_MOTION_POSES */
    uint32_t reserved; /* 0 */
} cdprep_motion;

/* Stores the pose at a time from 0 to 1. With CDPREP_MOTION_POSES, the pose at time 0 is `start`
 * and at time 1 `end`, bit for bit. Uses the sine and cosine of the C library, so the last bits may
 * differ between platforms. On failure, *pose is all 0. Errors: CDPREP_WHY_OUT_OF_RANGE for other
 * times, and for coordinates beyond 2^1000. */
CDPREP_API int cdprep_motion_pose(const cdprep_motion* motion, double time, cdprep_pose* pose,
                                  cdprep_error* error);

typedef struct cdprep_moving_pair {
    cdprep_head head;
    const cdprep_model* a;
    const cdprep_model* b;
    uint32_t body;       /* CDPREP_SURFACE */
    uint32_t most_steps; /* 256: the search ends after this many distance queries */
    /* 0. The search ends when no point moves farther than this between `lower` and `upper`,
     * relative to the other model. It also ends after narrowing [lower, upper] 32 times. Otherwise
     * it ends when the surfaces are this near, and no time of contact is found. Model units. A
     * tolerance close to rounding errors is raised. */
    double tolerance;
    cdprep_motion motion_a, motion_b; /* no motion, at the identity */
} cdprep_moving_pair;

CDPREP_API void cdprep_moving_pair_init(cdprep_moving_pair* pair, size_t size);

enum {
    CDPREP_IMPACT_NONE = 0,       /* the models do not touch during the step */
    CDPREP_IMPACT_TOUCHING = 1,   /* they touch first at a time in [lower, upper] */
    CDPREP_IMPACT_NEAR = 2,       /* within the tolerance at `lower`; a contact may follow or not */
    CDPREP_IMPACT_UNFINISHED = 3, /* most_steps ended the search; a contact may follow `lower` */
    CDPREP_IMPACT_UNKNOWN = 4     /* the call failed */
};

typedef struct cdprep_impact {
    uint32_t kind;  /* CDPREP_IMPACT_ */
    uint32_t steps; /* distance queries of the search, not counting that for `nearest` */
    double lower;   /* at all times before this, the surfaces are apart; 1 for _NONE */
    double upper;   /* at this time they touch; infinity if no such time was found */
    /* At `lower`, in world coordinates. `found` is CDPREP_NO for _NONE, and for a contact at time
     * 0. */
    cdprep_nearest nearest;
} cdprep_impact;

/* Stores when two moving models first touch: an interval of time that holds the first contact. The
 * models are placed by cdprep_motion_pose(), as with CDPREP_MOVE_BOTH. At each time before `lower`
 * that is a double, the surfaces are apart. At `upper` they touch. So nothing passes through
 * unseen, however fast or thin it is. If the models touch at time 0, `lower` and `upper` are 0.
 * With CDPREP_SOLID, a model inside the other also touches it at time 0. On failure, `kind` is
 * CDPREP_IMPACT_UNKNOWN.
 *
 * If the search ends at the tolerance without a contact, `kind` is CDPREP_IMPACT_NEAR. The models
 * may then pass each other closely, or touch later. In a solver, treat this result as an impact at
 * `lower`.
 *
 * Each step of the search takes one distance query. Models that pass at a distance take 2 or 3
 * steps; an impact takes about 10. Never allocates.
 * Errors: CDPREP_WHY_OUT_OF_RANGE also for a motion beyond 2^1000, or a turn of more than 1000.
 * Needs: CDPREP_ASK_DISTANCE; CDPREP_SOLID: also CDPREP_ASK_SOLID */
CDPREP_API int cdprep_time_of_impact(const cdprep_moving_pair* pair, cdprep_workspace* workspace,
                                     cdprep_impact* impact, cdprep_error* error);

/* The space through which a deforming model passes during a step: boxes around the path of each of
 * its triangles. Each vertex moves along a straight line, at constant speed. So a thin object is
 * found even if a triangle jumps over it in one step. Call cdprep_sweep_start_step(), move the
 * model, call cdprep_sweep_finish_step(), then query. While one of these two functions runs,
 * another call of either fails with CDPREP_WHY_BUSY. A query between them fails with
 * CDPREP_WHY_STALE. No query may run at the same time as one of them: this is not checked. */
typedef struct cdprep_sweep cdprep_sweep;

/* Stores the number of bytes that cdprep_sweep_make() needs: 24 per vertex and about 4
 * per triangle. On failure *size is 0.
 * Errors: CDPREP_OVER_BUDGET: the sweep is larger than memory can be, with pointers of 32 bits.
 * Needs of the model: CDPREP_ASK_WITHIN, CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_sweep_size(const cdprep_model* model, size_t* size, cdprep_error* error);

/* Makes the sweep of a model that deforms in place, such as the model of a cdprep_live. The model
 * must outlive the sweep. At first, nothing moves. On failure *sweep is null. End it with
 * cdprep_sweep_end(). `memory` must start at a multiple of CDPREP_ALIGNMENT and have at least
 * cdprep_sweep_size() bytes. If `memory` is null and `size` is 0, the allocator makes one
 * allocation. A null allocator means the heap. No later call allocates.
 * Errors: CDPREP_WHY_TOO_SMALL, CDPREP_WHY_OUT_OF_RANGE and CDPREP_WHY_NO_MEANING for memory, as in
 * cdprep_live_make(); CDPREP_OVER_BUDGET.
 * Needs of the model: CDPREP_ASK_WITHIN, CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_sweep_make(const cdprep_model* model, const cdprep_allocator* allocator,
                                 void* memory, size_t size, cdprep_sweep** sweep,
                                 cdprep_error* error);

/* Ends a sweep. Does nothing for null, or while another call starts or finishes a step. */
CDPREP_API void cdprep_sweep_end(cdprep_sweep* sweep);

/* Begins a step: the positions of the model are those at time 0. Takes O(vertices) time. */
CDPREP_API int cdprep_sweep_start_step(cdprep_sweep* sweep, cdprep_error* error);

/* Completes the step: the positions of the model are those at time 1. A triangle that was appended
 * within the step starts at its vertices' positions at time 0. Vertices without a position at time
 * 0 start where the first vertex of the base was. If the base was empty, they start at the origin.
 * A triangle that was removed within the step is left out. Takes O(n) time. */
CDPREP_API int cdprep_sweep_finish_step(cdprep_sweep* sweep, cdprep_error* error);

/* Both functions find the pairs of triangles that may touch during the step. Triangle `a` is of the
 * deforming model, whose coordinates are those of the world. `b` is of another model, which
 * `motion` moves. The first function stops at the first pair and stores CDPREP_YES. The second
 * function lists all pairs in the order of (a, b). If there is too little room, the list keeps the
 * smallest pairs.
 *
 * CDPREP_NO is certain: no triangles touch at any time of the step. CDPREP_YES means that the
 * convex hull of a triangle's path comes near a triangle of the other model. The path is relative
 * to that model. Whether and when the triangles touch is not known. Containment is not tested. A
 * model is not tested against itself, nor against another model that deforms. Triangles that were
 * removed during the step are left out. A step with less motion gives fewer false alarms. If the
 * other model turns by more than 0.25 radians, the step is tested in up to 64 parts.
 *
 * Takes as long as cdprep_within() with a tolerance of half of the other model's motion. Each pair
 * of triangles near each other takes about 1 us more for each part. Never allocates.
 * Errors: CDPREP_WHY_STALE: the step is not finished, or the model was moved, torn, rebuilt or
 * passed to cdprep_live_image() since.
 * Needs of the other model: CDPREP_ASK_WITHIN */
CDPREP_API int cdprep_sweep_may_touch(const cdprep_sweep* sweep, const cdprep_model* other,
                                      const cdprep_motion* motion, cdprep_workspace* workspace,
                                      uint32_t* may_touch, cdprep_error* error);
CDPREP_API int cdprep_sweep_pairs(const cdprep_sweep* sweep, const cdprep_model* other,
                                  const cdprep_motion* motion, cdprep_workspace* workspace,
                                  cdprep_overlap_list* list, cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_MOTION_H */
