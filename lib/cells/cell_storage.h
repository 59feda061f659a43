// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "cells/candidate_nodes.h"
#include "cells/cell_bounds.h"
#include "cells/node_lists.h"
#include "cells/tested_pairs.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// The scratch memory of searches through octrees and tetra-trees.
struct CellStorage {
    // Members aligned to cache lines come first, so that no padding is needed between.
    NodeLists<64> node_lists_a;
    NodeLists<64> node_lists_b;
    TestedPairs tested_pairs;
    FirstPlaces first_places;
    std::array<PendingLeaves, kernels::kLeafBatch> pending_leaves;  ///< of the batch's leaf pairs
    MetNodes met_nodes;
    KeptBounds bounds_a;
    KeptBounds bounds_b;
    CandidateNodes candidate_nodes;
};

/// Returns the cell storage of a workspace that was made with cells().
[[nodiscard]] inline CellStorage& cells_of(Workspace::Storage& scratch) noexcept {
    assert(scratch.cells != nullptr);
    return *static_cast<CellStorage*>(scratch.cell_storage);
}

}  // namespace cdprep
