/* SPDX-License-Identifier: MIT */
/* In which frames does a part hit an arm, as it slides along x?
 *
 *     sample_collide arm.cdp.h5 part.cdp.h5 */
#include <stdio.h>

#include "cdprep/cdprep.h"

static int fail(const cdprep_error* error) {
    fprintf(stderr, "%s: %s\n", cdprep_code_name(error->code), error->message);
    return error->code;
}

int main(int argc, char** argv) {
    cdprep_error error;
    cdprep_model *arm = NULL, *part = NULL;
    cdprep_workspace* workspace = NULL;
    cdprep_open_options open;
    cdprep_pair pair;
    cdprep_collision answer;
    cdprep_cache cache = {{0}}; /* frames that follow each other are answered faster */
    int code = CDPREP_OK;
    if (argc != 3) return fputs("usage: sample_collide ARM PART\n", stderr), 2;

    cdprep_open_options_init(&open, sizeof open); /* only this makes a valid struct */
    open.ask = CDPREP_ASK_COLLIDE;                /* a file that lacks it is refused here */
    if (cdprep_model_open(argv[1], &open, &arm, &error) ||
        cdprep_model_open(argv[2], &open, &part, &error) ||
        cdprep_workspace_make(NULL, NULL, 0, &workspace, &error)) {
        code = fail(&error);
    }
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = arm;
    pair.b = part;
    pair.cache = &cache;
    for (int frame = 0; frame < 600 && code == CDPREP_OK; ++frame) {
        pair.pose_b.rows[9] = 0.01 * frame; /* x */
        if (cdprep_collide(&pair, workspace, &answer, &error))
            code = fail(&error);
        else if (answer.hit == CDPREP_YES)
            printf("frame %d\n", frame);
    }
    cdprep_workspace_end(workspace);
    cdprep_model_close(part);
    cdprep_model_close(arm);
    return code;
}
