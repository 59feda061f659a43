// SPDX-License-Identifier: MIT
#include "cdprep/c/base.h"
#include "cdprep/cells.h"

const cdprep_cell_searches* cdprep_cells(void) {
    return reinterpret_cast<const cdprep_cell_searches*>(&cdprep::cells());
}
