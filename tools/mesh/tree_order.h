// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// A mesh in the order of the BVH.
struct TreeOrdered {
    Mesh mesh;  ///< triangles in tree order, vertices in the order of their first use
    std::vector<std::uint32_t> new_vertex;  ///< the new number of each vertex of the old mesh
};

/// Moves triangle order[i] to position i, and renumbers vertices by first use. Neighbours in the
/// tree are then neighbours in memory. `order` must be a permutation of the triangles.
[[nodiscard]] TreeOrdered in_tree_order(const Mesh& mesh, std::span<const std::uint32_t> order);

}  // namespace cdprep::mesh
