/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_TESTS_C_FACE_H
#define CDPREP_TESTS_C_FACE_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Asks every question of cdprep.h about a baked unit cube, in memory and at
 * `path`, as a C99 program would. Returns null, or the first thing that was wrong. */
const char* ask_everything(const void* bytes, size_t size, const char* path);

#ifdef __cplusplus
}
#endif

#endif
