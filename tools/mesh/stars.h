// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// A triangle seen from one of its corners.
struct StarCorner {
    std::uint32_t triangle;
    std::uint32_t before;  ///< the corner that comes before, in its winding
    std::uint32_t after;   ///< and after
};

/// The triangles around each vertex: everything about edges and fans can be told from
/// them, one vertex at a time.
struct Stars {
    std::vector<std::uint32_t> first;  ///< one more than vertices
    std::vector<StarCorner> corner;    ///< of vertex v in [first[v], first[v + 1])

    /// By ascending triangle.
    [[nodiscard]] std::span<const StarCorner> at(std::uint32_t vertex) const {
        return std::span(corner).subspan(first[vertex], first[vertex + 1] - first[vertex]);
    }
};

/// Requires triangles with three different corners. O(n).
[[nodiscard]] Stars collect_stars(const Mesh& mesh);

/// True only when the star is one closed fan wound one way: each of its edges is used by
/// two triangles, in opposite directions. Then nothing is wrong with it, unless it has but
/// two triangles. Says false of large stars without looking.
[[nodiscard]] bool is_one_closed_fan(std::span<const StarCorner> star);

/// One use of an edge at the star's vertex.
struct EdgeUse {
    std::uint32_t other;   ///< the edge's other end
    std::uint32_t corner;  ///< number in the star
    bool outgoing;         ///< the triangle runs through it towards `other`
};

/// Puts the uses of all edges of a star in `uses`, sorted by `other`, then corner.
void sort_edge_uses(std::span<const StarCorner> star, std::vector<EdgeUse>& uses);

}  // namespace cdprep::mesh
