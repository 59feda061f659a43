// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "decompose/enclose/distance_field.h"
#include "decompose/enclose/solid.h"

namespace cdprep::convex {

/// The place of a fragment's corner: an axis-aligned box, usually a point. Cuts are rounded; the
/// box contains the exact place.
struct Place {
    Double3 lower;
    Double3 upper;
};

/// A triangle of the mesh, or what a cut left of one. The exact fragments of a triangle
/// cover it, and may overlap.
struct Fragment {
    std::array<std::uint32_t, 3> place;
    std::uint32_t triangle;
};

/// What one body has in a box. The hull of all places of its fragments and of `corners` contains
/// that, exactly.
struct SolidCell {
    mesh::Box box;
    std::uint32_t body;
    std::vector<std::uint32_t> fragments;
    std::vector<Double3> corners;  ///< of the box, within the body
};

/// A solid cut into cells. Together the cells contain all of it.
struct SolidCells {
    std::vector<Place> places;        ///< the mesh's vertices first
    std::vector<Fragment> fragments;  ///< of wanted bodies each in one cell
    std::vector<SolidCell> cells;
    std::vector<std::uint32_t> fragment_count;  ///< of each triangle, copies included
};

struct SolidCellOptions {
    double size = 0;   ///< longest side of a box with surface in it, model units
    double error = 0;  ///< boxes whose hulls stick out farther are cut, to 1/8 of `size`
    std::size_t most_cells = 8'000;  ///< boxes stay larger where there would be more
    /// Cutting ends once there are more.
    std::size_t most_fragments = 20'000'000;
    ParallelFor parallel_for = serial_for;
};

/// Cuts boxes in two across their longest side until they are small enough. Cuts prefer coordinates
/// that several vertices share, so that no cut runs close to an edge of a machined body. Triangles
/// much smaller than a cell are not cut: every cell that they may meet has a copy. A copy sticks
/// out of a cell by at most an eighth of its longest side. A triangle in a cut's plane goes to the
/// side of its body. The same for any parallel_for.
[[nodiscard]] SolidCells cut_into_cells(const mesh::Mesh& mesh, const Solid& solid,
                                        const DistanceField& field,
                                        const SolidCellOptions& options);

}  // namespace cdprep::convex
