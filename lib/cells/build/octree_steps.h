// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cdprep/cells/build_octree.h"

namespace cdprep::build {

/// Fills the tables that find cells by their keys, from octree.nodes: leaf_codes, leaf_nodes, top
/// and the two hash tables. Also sets grid.top_level and grid.slot_bits.
void make_octree_tables(Octree& octree);

/// Fills octree.nodes and octree.references. octree.grid is set, except for the tables. There is at
/// least one triangle.
void divide_octree(Octree& octree, std::span<const format::Double3> positions,
                   std::span<const format::Triangle> triangles, ParallelFor parallel_for);

}  // namespace cdprep::build
