// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// A mesh rearranged for the hierarchy.
struct TreeOrdered {
    Mesh mesh;  ///< triangles in tree order, vertices in the order of their first use
    std::vector<std::uint32_t> new_vertex;  ///< where each vertex of the old mesh went
};

/// Puts triangle order[i] at place i and renumbers vertices by first use, so
/// that neighbours in the tree are neighbours in memory. `order` is a
/// permutation of the triangles.
[[nodiscard]] TreeOrdered in_tree_order(const Mesh& mesh, std::span<const std::uint32_t> order);

}  // namespace cdprep::mesh
