/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_TESTS_C_FACE_H
#define CDPREP_TESTS_C_FACE_H

#include <stddef.h>

#include "cdprep/cdprep.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Asks every question of cdprep.h about a baked unit cube, in memory and at
 * `path`, as a C99 program would. Returns null, or the first thing that was wrong. */
const char* ask_everything(const void* bytes, size_t size, const char* path);

/* Asks a baked ball of radius 1 and a smaller solid many times over by `threads`, one to eight of
 * them, and compares with the same questions asked one by one. Returns likewise. */
const char* ask_many(const void* bytes_a, size_t size_a, const void* bytes_b, size_t size_b,
                     const cdprep_parallel_for* threads);

/* Asks every question about hulls of a baked unit cube that has them. Returns likewise. */
const char* ask_hulls(const void* bytes, size_t size);

/* Asks every question about convex pieces of a baked unit cube that is one, with memory for a
 * workspace. Returns likewise. */
const char* ask_contacts(const void* bytes, size_t size, void* memory, size_t room);

#ifdef __cplusplus
}
#endif

#endif
