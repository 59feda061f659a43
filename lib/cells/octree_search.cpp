// SPDX-License-Identifier: MIT
#include "cdprep/cells/octree_search.h"

#include "cdprep/format/float_environment.h"
#include "cells/octree_codes.h"
#include "core/require.h"

namespace cdprep {

OctreeIndex octree_index(const Model& model) noexcept {
    if (model.octree().grid == nullptr) refuse(model, Ask::octree);
    const auto nodes = model.octree().nodes;
    return {.top_level = model.octree().grid->top_level,
            .slot_bits = model.octree().grid->slot_bits,
            .deepest = nodes.empty() ? 0 : level_of(nodes.back().key),
            .nodes = nodes,
            .leaf_codes = model.octree().leaf_codes,
            .leaf_nodes = model.octree().leaf_nodes,
            .top = model.octree().top,
            .modulus_table = model.octree().modulus_table,
            .mixed_table = model.octree().mixed_table};
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

std::uint64_t code_of_point(const format::OctreeGrid& grid, const Double3& p) noexcept {
    const format::FloatEnvironment environment;
    return octree_code(octree_cell(grid, p));
}

}  // namespace cdprep
