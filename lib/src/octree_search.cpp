// SPDX-License-Identifier: MIT
#include "octree_search.h"

namespace cdprep {

OctreeIndex octree_index(const Model& model) noexcept {
    const auto nodes = model.octree_nodes();
    return {.top_level = model.octree_grid()->top_level,
            .slot_bits = model.octree_grid()->slot_bits,
            .deepest = nodes.empty() ? 0 : level_of(nodes.back().key),
            .nodes = nodes,
            .leaf_codes = model.octree_leaf_codes(),
            .leaf_nodes = model.octree_leaf_nodes(),
            .top = model.octree_top(),
            .modulus_table = model.octree_modulus_table(),
            .mixed_table = model.octree_mixed_table()};
}

OctreeIndex octree_index(const build::Octree& octree) noexcept {
    const auto& nodes = octree.nodes;
    return {.top_level = octree.grid.top_level,
            .slot_bits = octree.grid.slot_bits,
            .deepest = nodes.empty() ? 0 : level_of(nodes.back().key),
            .nodes = nodes,
            .leaf_codes = octree.leaf_codes,
            .leaf_nodes = octree.leaf_nodes,
            .top = octree.top,
            .modulus_table = octree.modulus_table,
            .mixed_table = octree.mixed_table};
}

}  // namespace cdprep
