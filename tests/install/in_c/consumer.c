/* SPDX-License-Identifier: MIT */
/* Opens a file that is not there, and makes a workspace for every structure: proves that headers
 * and libraries fit together in C. */
#include <cdprep/cdprep.h>
#include <stdio.h>

int main(void) {
    cdprep_error error;
    cdprep_version version;
    cdprep_model* model = NULL;
    cdprep_workspace* workspace = NULL;
    cdprep_workspace_options options;
    int made, refused;

    cdprep_version_get(&version);
    cdprep_workspace_options_init(&options, sizeof options);
    options.cells = cdprep_cells();
    made = cdprep_workspace_make(&options, NULL, 0, &workspace, &error) == CDPREP_OK;
    if (!made) puts(error.message);
    cdprep_workspace_end(workspace);
    refused = cdprep_model_open("no such file.cdp.h5", NULL, &model, &error) == CDPREP_UNREADABLE;
    printf("cdprep %u.%u.%u: %s\n", version.major, version.minor, version.patch, error.message);
    return made && refused && version.minor == CDPREP_VERSION_MINOR ? 0 : 1;
}
