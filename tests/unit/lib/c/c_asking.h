/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_TESTS_C_ASKING_H
#define CDPREP_TESTS_C_ASKING_H

#include <stdint.h>

#include "cdprep/cdprep.h"

#define TEXT(x) #x
#define LINE(x) TEXT(x)

/* Ends a function that returns the first thing that is wrong. */
#define MUST(condition)                                                           \
    do {                                                                          \
        if (!(condition)) return __FILE__ ":" LINE(__LINE__) ": not " #condition; \
    } while (0)

/* Of answers that were visited: how many, how many more are wanted, and the sum of their
 * triangles. */
typedef struct visits {
    size_t count;
    size_t left;
    size_t triangles;
} visits;

static inline visits visit_most(size_t most) {
    const visits all = {0, most, 0};
    return all;
}

static inline int take(visits* so_far, size_t triangles) {
    ++so_far->count;
    so_far->triangles += triangles;
    return so_far->left-- > 1;
}

/* Two models, of which B is moved along x. */
static inline cdprep_pair moved_by(const cdprep_model* a, const cdprep_model* b, double x) {
    cdprep_pair pair;
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = a;
    pair.b = b;
    pair.pose_b.rows[9] = x;
    return pair;
}

#endif
