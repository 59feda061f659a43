// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Calls visit(a, b), a < b, for pairs of the triangles around a vertex, which have area:
/// each at most once, in no order, and every two that have more in common than the corners
/// and edges they share.
///
/// Few others where they are seen in different directions from the vertex, or share an edge
/// and lie at different angles around it. O(k log k) for k triangles, and O(pairs) for those
/// that overlap as seen from the vertex.
void for_star_pairs(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star,
                    const std::function<void(std::uint32_t, std::uint32_t)>& visit);

}  // namespace cdprep::mesh
