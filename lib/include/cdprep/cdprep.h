/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_CDPREP_H
#define CDPREP_CDPREP_H

/* The C API: all queries about models, for C99 and for languages that call C. cdprep/c/base.h
 * states the rules that hold for every function. The comment of each function states the rest. The
 * headers contain no inline functions and no floating-point arithmetic.
 *
 *     cdprep_pair pair;
 *     cdprep_pair_init(&pair, sizeof pair);
 *     pair.a = arm;
 *     pair.b = part;
 *     pair.pose_b.rows[9] = 0.1;
 *     if (cdprep_collide(&pair, workspace, &collision, &error)) puts(error.message); */

#include "cdprep/c/base.h"
#include "cdprep/c/build.h"
#include "cdprep/c/contacts.h"
#include "cdprep/c/draw.h"
#include "cdprep/c/live.h"
#include "cdprep/c/model.h"
#include "cdprep/c/motion.h"
#include "cdprep/c/pairs.h"
#include "cdprep/c/points.h"
#include "cdprep/c/scene.h"
#include "cdprep/c/window.h"

#endif /* CDPREP_CDPREP_H */
