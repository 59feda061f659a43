// SPDX-License-Identifier: MIT
// The C functions of the library cdprep_cells.
#include "c/c_model.h"
#include "cdprep/c/base.h"
#include "cdprep/cells.h"
#include "cdprep/cells/level_of_detail.h"

using namespace cdprep::c;
using cdprep::Ask;

const cdprep_cell_searches* cdprep_cells(void) {
    return reinterpret_cast<const cdprep_cell_searches*>(&cdprep::cells());
}

int cdprep_model_level_error(const cdprep_model* model, uint32_t level, double* bound,
                             cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (bound != nullptr) *bound = 0;
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = call.need(bound, {"bound"})) return code;
        if (const int code = check_serves(call, {"model"}, *model, Ask::tetra_tree)) return code;
        *bound = cdprep::level_error(model->model, level);
        return CDPREP_OK;
    });
}
