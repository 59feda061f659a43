/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_TESTS_C_ASKING_H
#define CDPREP_TESTS_C_ASKING_H

#include "cdprep/cdprep.h"

#define TEXT(x) #x
#define LINE(x) TEXT(x)

/* Ends a function that returns the first thing that is wrong. */
#define MUST(condition)                                                           \
    do {                                                                          \
        if (!(condition)) return __FILE__ ":" LINE(__LINE__) ": not " #condition; \
    } while (0)

/* B is moved along x, and nothing turns. */
static cdprep_placement moved_by(double x) {
    cdprep_placement placement = {sizeof placement,
                                  CDPREP_B_MOVES,
                                  {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}},
                                  {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}}};
    placement.b.rows[9] = x;
    return placement;
}

#endif
