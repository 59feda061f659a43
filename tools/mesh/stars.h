// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// A triangle as seen from one of its corners.
struct StarCorner {
    std::uint32_t triangle;
    std::uint32_t before;  ///< the previous corner, in its winding
    std::uint32_t after;   ///< the next corner
};

/// The triangles around each vertex. All facts about edges and fans follow from them, one vertex
/// at a time.
struct Stars {
    std::vector<std::uint32_t> first;  ///< one entry more than vertices
    std::vector<StarCorner> corner;    ///< of vertex v in [first[v], first[v + 1])

    /// Returns the corners by ascending triangle.
    [[nodiscard]] std::span<const StarCorner> at(std::uint32_t vertex) const {
        return std::span(corner).subspan(first[vertex], first[vertex + 1] - first[vertex]);
    }
};

/// Triangles must have three different corners. O(n).
[[nodiscard]] Stars collect_stars(const Mesh& mesh);

/// Returns true only if the star is one closed fan with one winding: two triangles use each of
/// its edges, in opposite directions. Such a star has no flaws, unless it has only two
/// triangles. Returns false for large stars without a test.
[[nodiscard]] bool is_one_closed_fan(std::span<const StarCorner> star);

/// One use of an edge at the star's vertex.
struct EdgeUse {
    std::uint32_t other;   ///< the edge's other end
    std::uint32_t corner;  ///< index in the star
    bool outgoing;         ///< the triangle uses it in the direction of `other`
};

/// Writes the uses of all edges of a star to `uses`, sorted by `other`, then corner.
void sort_edge_uses(std::span<const StarCorner> star, std::vector<EdgeUse>& uses);

}  // namespace cdprep::mesh
