// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/format/octree.h"
#include "cdprep/format/tetra_tree.h"
#include "cdprep/parallel_for.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// A tetra-tree as a baked file has it.
struct TetraLists {
    const format::TetraTree& tree;
    std::span<const format::TetraNode> nodes;
    std::span<const std::uint32_t> references;
};

/// Which triangles nothing reaches that comes straight towards the centre.
struct Inaccessible {
    std::vector<std::uint32_t> triangles;  ///< numbers in `triangles`, rising
    /// Triangles that cover no direction, since their plane holds the centre or they are
    /// degenerate: the criterion says nothing of them and they are not among `triangles`.
    std::uint64_t edge_on = 0;
};

/// Finds the triangles that others hide along every ray towards the tree's centre: the
/// selection of inaccessible parts of the tetra-tree papers. A radial criterion, not true
/// accessibility: what a straight approach to the centre cannot reach, a bent one may,
/// and an undercut that is seen from the side counts as hidden.
///
/// Exact, whatever the tree's depth; the tree tells which triangles can hide which.
/// Deterministic. O(n leaf size) at worst: trees with few triangles a leaf are fast.
[[nodiscard]] Inaccessible find_inaccessible(const TetraLists& tree,
                                             std::span<const Double3> positions,
                                             std::span<const Triangle> triangles,
                                             ParallelFor parallel_for = serial_for);

}  // namespace cdprep::mesh
