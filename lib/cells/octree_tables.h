// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/cells/build_octree.h"

namespace cdprep::build {

/// Fills what finds cells by their keys, from octree.nodes: leaf_codes, leaf_nodes, top and
/// the two tables; and grid.top_level and grid.slot_bits.
void make_octree_tables(Octree& octree);

}  // namespace cdprep::build
