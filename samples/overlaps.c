/* SPDX-License-Identifier: MIT */
/* Which triangles of two models overlap, and where are they?
 *
 *     sample_overlaps a.cdp.h5 b.cdp.h5 */
#include <stdio.h>

#include "cdprep/cdprep.h"

static void print_triangle(unsigned number, const cdprep_corners* corners) {
    printf("%u:", number);
    for (int k = 0; k < 3; ++k) {
        const double* p = corners->point[k];
        printf(" (%g %g %g)", p[0], p[1], p[2]);
    }
}

static int print_overlaps(const cdprep_pair* pair, cdprep_workspace* workspace,
                          cdprep_error* error) {
    cdprep_overlap found[256];
    cdprep_overlap_list list = {found, 256, 0}; /* count: how many there are */
    cdprep_corners a, b;
    int code = cdprep_overlaps(pair, workspace, &list, error);
    for (size_t i = 0; !code && i < list.count && i < list.room; ++i) {
        if ((code = cdprep_model_corners(pair->a, &found[i].a, 1, &a, error))) break;
        if ((code = cdprep_model_corners(pair->b, &found[i].b, 1, &b, error))) break;
        print_triangle(found[i].a, &a);
        print_triangle(found[i].b, &b);
        putchar('\n');
    }
    if (!code) printf("%zu pairs\n", list.count);
    return code;
}

int main(int argc, char** argv) {
    cdprep_error error;
    cdprep_model *a = NULL, *b = NULL;
    cdprep_workspace* workspace = NULL;
    cdprep_pair pair;
    int code;
    if (argc != 3) return fputs("usage: sample_overlaps A B\n", stderr), 2;
    if (!(code = cdprep_model_open(argv[1], NULL, &a, &error)) &&
        !(code = cdprep_model_open(argv[2], NULL, &b, &error)) &&
        !(code = cdprep_workspace_make(NULL, NULL, 0, &workspace, &error))) {
        cdprep_pair_init(&pair, sizeof pair);
        pair.a = a;
        pair.b = b;
        code = print_overlaps(&pair, workspace, &error);
    }
    if (code) fprintf(stderr, "%s\n", error.message);
    cdprep_workspace_end(workspace);
    cdprep_model_close(b);
    cdprep_model_close(a);
    return code;
}
