// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/stars.h"

namespace cdprep::mesh {

/// An edge that is not used by two triangles in opposite directions. Numbers of the mesh.
struct FlawedEdge {
    std::uint32_t triangle;  ///< the lowest triangle that uses it
    std::uint32_t from;      ///< in the direction of that triangle
    std::uint32_t to;
    std::uint32_t uses;  ///< the number of triangles that use it
};

/// A vertex whose triangles form more than one fan.
struct PinchedVertex {
    std::uint32_t vertex;
    std::uint32_t fans;
};

/// A triangle with the corners of a lower one.
struct RepeatedTriangle {
    std::uint32_t triangle;
    std::uint32_t first;  ///< the lowest triangle with these corners
    bool opposite;        ///< its winding is opposite to that of `first`
};

/// All flaws of edges and stars, in unspecified order. All lists are empty for a closed,
/// 2-manifold, oriented surface.
struct EdgeFlaws {
    std::vector<FlawedEdge> boundary;      ///< used by one triangle
    std::vector<FlawedEdge> non_manifold;  ///< by more than two
    std::vector<FlawedEdge> inconsistent;  ///< by two, in the same direction
    std::vector<std::uint32_t>
        unbalanced;  ///< an end of each edge whose oriented uses do not cancel
    std::vector<PinchedVertex> pinched;
    std::vector<RepeatedTriangle> repeated;
};

/// Returns the flaws. O(n), and O(d log d) around vertices with d triangles and a flaw.
[[nodiscard]] EdgeFlaws find_edge_flaws(const Stars& stars);

/// Returns the lowest triangle of each fan of a star, ascending.
[[nodiscard]] std::vector<std::uint32_t> lowest_of_fans(std::span<const StarCorner> star);

}  // namespace cdprep::mesh
