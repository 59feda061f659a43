// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/stars.h"

namespace cdprep::mesh {

/// An edge that is not used by two triangles in opposite directions. Numbers of the mesh.
struct FlawedEdge {
    std::uint32_t triangle;  ///< the lowest that uses it
    std::uint32_t from;      ///< as that triangle runs through it
    std::uint32_t to;
    std::uint32_t uses;  ///< how many triangles
};

/// A vertex whose triangles form more than one fan.
struct PinchedVertex {
    std::uint32_t vertex;
    std::uint32_t fans;
};

/// A triangle with the corners of a lower one.
struct RepeatedTriangle {
    std::uint32_t triangle;
    std::uint32_t first;  ///< the lowest with these corners
    bool opposite;        ///< wound the other way than that
};

/// All that is wrong with edges and stars, in no useful order. Nothing here of a closed,
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

/// O(n), and O(d log d) around vertices with d triangles where something is wrong.
[[nodiscard]] EdgeFlaws find_edge_flaws(const Stars& stars);

/// Returns for each fan of a star its lowest triangle, ascending.
[[nodiscard]] std::vector<std::uint32_t> lowest_of_fans(std::span<const StarCorner> star);

}  // namespace cdprep::mesh
