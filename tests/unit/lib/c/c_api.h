/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_TESTS_C_API_H
#define CDPREP_TESTS_C_API_H

#include <stddef.h>

#include "cdprep/cdprep.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Each asks questions as a C99 program would and returns null, or the first thing that was
 * wrong. */

/* Everything about two models, of a baked unit cube. */
const char* ask_pairs(const cdprep_model* cube, cdprep_workspace* workspace);

/* Everything about points, rays and shapes, of the same. */
const char* ask_points(const cdprep_model* cube, cdprep_workspace* workspace);

/* A ball of radius 1 and a smaller solid, many times over with up to eight lanes, which `options`
 * runs; compared with the same questions one by one. */
const char* ask_many(const cdprep_model* a, const cdprep_model* b,
                     const cdprep_workspace_options* options);

/* Everything about hulls, of a unit cube that has them. */
const char* ask_hulls(const cdprep_model* cube);

/* Everything about contacts, of a unit cube that is one convex piece. */
const char* ask_contacts(const cdprep_model* cube, cdprep_workspace* workspace);

/* Describes a unit cube and reads all of its geometry. */
const char* read_geometry(const cdprep_model* cube);

/* Everything about plans and scenes, of a unit cube; in `memory` as well. */
const char* ask_scene(const cdprep_model* cube, cdprep_workspace* workspace, void* memory,
                      size_t size);

/* Everything about the broad phase; in `memory` as well. */
const char* ask_broad_phase(cdprep_workspace* workspace, void* memory, size_t size);

#ifdef __cplusplus
}
#endif

#endif
