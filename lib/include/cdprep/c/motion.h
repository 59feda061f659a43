/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_MOTION_H
#define CDPREP_C_MOTION_H

#include "cdprep/c/pairs.h"

/* The time at which two moving models first touch. */

/* What tells a motion. */
enum {
    CDPREP_MOTION_POSES = 0,   /* `start` and `end`; the model turns the shorter way between them */
    CDPREP_MOTION_VELOCITY = 1 /* `start`, `shift` and `turn` */
};

/* The rigid motion of a model during a step, from time 0 to time 1. One point of the model, the
 * centre, moves along a straight line at constant speed. The model turns about it, about a fixed
 * axis at constant speed. The centre of mass is a good centre for a free body, the joint for a part
 * that turns about it. A centre far outside the model makes the query slow. */
typedef struct cdprep_motion {
    cdprep_pose start;
    cdprep_pose end;  /* used only by CDPREP_MOTION_POSES; otherwise the identity */
    double centre[3]; /* in the model's coordinates; 0 */
    double shift[3];  /* the way of the centre; used only by CDPREP_MOTION_VELOCITY; otherwise 0 */
    double turn[3];   /* the same: along the axis, its length is the angle; radians, 1000 at most */
    uint32_t told_by; /* CDPREP_MOTION_POSES */
    uint32_t reserved; /* 0 */
} cdprep_motion;

/* Stores the pose at a time from 0 to 1. At the ends of a CDPREP_MOTION_POSES, it is `start` or
 * `end`, bit for bit. Uses the sine and cosine of the C library, so the last bits may differ
 * between platforms. On failure, *pose is all 0. Errors: CDPREP_WHY_OUT_OF_RANGE for other times,
 * and for places beyond 2^1000. */
CDPREP_API int cdprep_motion_pose(const cdprep_motion* motion, double time, cdprep_pose* pose,
                                  cdprep_error* error);

typedef struct cdprep_moving_pair {
    cdprep_head head;
    const cdprep_model* a;
    const cdprep_model* b;
    uint32_t body;       /* CDPREP_SURFACE */
    uint32_t most_steps; /* 256: the search ends after so many distance queries */
    /* 0. The search ends when no point moves farther than this between `lower` and `upper`,
     * relative to the other model. It also ends when the surfaces are this near and no time of
     * contact is found. Model units; less than the rounding of coordinates counts as that. */
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
    uint32_t kind;          /* CDPREP_IMPACT_ */
    uint32_t steps;         /* distance queries */
    double lower;           /* at all times before, the surfaces are apart; 1 for _NONE */
    double upper;           /* at this time they touch; infinity if no such time was found */
    cdprep_nearest nearest; /* at `lower`, in world coordinates; nothing for _NONE and time 0 */
} cdprep_impact;

/* Stores when two moving models first touch: an interval of time that holds the first contact.
 * Placements are those of cdprep_motion_pose() with CDPREP_MOVE_BOTH. At each time before `lower`,
 * given as a double, the surfaces are apart. At `upper` they touch. So nothing passes through
 * unseen, however fast or thin it is. If the models touch at time 0, both are 0. A solid inside the
 * other also touches it then. On failure, `kind` is CDPREP_IMPACT_UNKNOWN.
 *
 * An end at the tolerance without a contact is CDPREP_IMPACT_NEAR: the models may pass each other
 * closely, or touch later. A solver treats it as an impact at `lower`.
 *
 * Takes a distance query for each step: 2 or 3 for models that pass at a distance, 10 or so for an
 * impact. Never allocates.
 * Errors: CDPREP_WHY_OUT_OF_RANGE also for a motion beyond 2^1000, or a turn of more than 1000.
 * Needs: CDPREP_ASK_DISTANCE; CDPREP_SOLID: also CDPREP_ASK_SOLID */
CDPREP_API int cdprep_time_of_impact(const cdprep_moving_pair* pair, cdprep_workspace* workspace,
                                     cdprep_impact* impact, cdprep_error* error);

#endif /* CDPREP_C_MOTION_H */
