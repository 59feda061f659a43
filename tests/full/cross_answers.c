/* SPDX-License-Identifier: MIT */
/* Prints what two models answer in each pose of a file: the number of pairs of triangles that
 * overlap, a hash of them in their order, and the bits of the distance. The same on every machine.
 * A pose is a line of 12 numbers, R row by row, then T. Usage: cross_answers A B POSES */
#include <stdio.h>
#include <stdlib.h>

#include "cdprep/cdprep.h"

static cdprep_error error;

static int fail(const char* what) {
    fprintf(stderr, "cross_answers: %s\n", what);
    return error.code ? error.code : CDPREP_BAD_ARGUMENT;
}

static int read_pose(FILE* file, cdprep_pose* pose) {
    for (int i = 0; i < 12; ++i) {
        if (fscanf(file, "%lf", &pose->rows[i]) != 1) return 0;
    }
    return 1;
}

/* FNV-1a over the words of all pairs. */
static uint32_t hash_of(const cdprep_overlap* pairs, size_t count) {
    uint32_t hash = 2166136261U;
    for (size_t i = 0; i < count; ++i) {
        hash = (hash ^ pairs[i].a) * 16777619U;
        hash = (hash ^ pairs[i].b) * 16777619U;
    }
    return hash;
}

static int print_answers(const cdprep_pair* pair, cdprep_workspace* workspace, unsigned number) {
    static cdprep_overlap pairs[1 << 20];
    cdprep_overlap_list list = {pairs, sizeof pairs / sizeof *pairs, 0};
    cdprep_nearest nearest;
    if (cdprep_overlaps(pair, workspace, &list, &error) ||
        cdprep_distance(pair, NULL, workspace, &nearest, &error)) {
        return error.code;
    }
    if (list.count > list.room) return CDPREP_OVER_BUDGET;
    printf("%u: %lu pairs %08lx, distance %.17g to %.17g\n", number, (unsigned long)list.count,
           (unsigned long)hash_of(pairs, list.count), nearest.lower, nearest.upper);
    return CDPREP_OK;
}

int main(int count, char** arguments) {
    cdprep_model *a, *b;
    cdprep_workspace* workspace;
    cdprep_pair pair;
    FILE* poses;
    unsigned number = 0;
    if (count != 4) return fail("Usage: cross_answers A B POSES");
    if (cdprep_model_open(arguments[1], NULL, &a, &error) ||
        cdprep_model_open(arguments[2], NULL, &b, &error) ||
        cdprep_workspace_make(NULL, NULL, 0, &workspace, &error)) {
        return fail(error.message);
    }
    poses = fopen(arguments[3], "r");
    if (!poses) return fail("The file of poses cannot be opened.");
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = a;
    pair.b = b;
    while (read_pose(poses, &pair.pose_b)) {
        if (print_answers(&pair, workspace, number++)) return fail(error.message);
    }
    fclose(poses);
    cdprep_workspace_end(workspace);
    cdprep_model_close(b);
    cdprep_model_close(a);
    return number > 0 ? 0 : fail("The file has no pose.");
}
