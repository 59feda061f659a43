// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// A triangle seen from one of its corners.
struct Sector {
    std::uint32_t from;  ///< the next corner
    std::uint32_t to;    ///< the one after
    Double3 way_from;    ///< to those corners
    Double3 way_to;
    Double3 normal;
    double size;  ///< product of the largest components of both ways
};

/// What looking at one star needs; kept from one to the next.
struct StarScratch {
    std::vector<Sector> sectors;
};

/// Whether the triangles around a vertex surely lie side by side: seen along some
/// direction they turn around the vertex in one open or closed fan that overlaps nowhere.
/// Any two of them then have nothing in common but shared corners and edges. False says
/// nothing. O(k^2) comparisons of numbers for k triangles, up to 64, and O(k) else.
[[nodiscard]] bool lies_side_by_side(const Mesh& mesh, std::uint32_t vertex,
                                     std::span<const std::uint32_t> star, StarScratch& scratch);

}  // namespace cdprep::mesh
