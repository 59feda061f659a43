// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "decompose/enclose/distance_field.h"
#include "decompose/enclose/solid.h"

namespace cdprep::convex {

/// Where a corner of a fragment lies: in a box with its sides along the axes, mostly a
/// point. Cuts are rounded; the box holds the exact place.
struct Place {
    Double3 lower;
    Double3 upper;
};

/// A triangle of the mesh or a part of one, as cuts make them. The exact fragments of a
/// triangle cover it, and may overlap.
struct Fragment {
    std::array<std::uint32_t, 3> place;
    std::uint32_t triangle;
};

/// What a box holds of one body. The hull of all places of its fragments and of the box's
/// corners within the body holds the body's part in the box, exactly.
struct SolidCell {
    mesh::Box box;
    std::uint32_t body;
    std::vector<std::uint32_t> fragments;
    std::vector<Double3> corners;  ///< of the box, within the body
};

/// A solid cut into cells. Together the cells hold all of it.
struct SolidCells {
    std::vector<Place> places;        ///< the mesh's vertices first
    std::vector<Fragment> fragments;  ///< of wanted bodies each in one cell
    std::vector<SolidCell> cells;
    std::vector<std::uint32_t> fragment_count;  ///< of each triangle, copies too
};

struct SolidCellOptions {
    double size = 0;   ///< longest side of a box with surface in it, model units
    double error = 0;  ///< boxes whose hulls stick out farther are cut on, to an eighth of it
    std::size_t most_cells = 8'000;  ///< boxes stay larger where there would be more
    /// As soon as there are more, boxes stay as they are.
    std::size_t most_fragments = 20'000'000;
    ParallelFor parallel_for = serial_for;
};

/// Cuts boxes in two across their longest side until they are small enough, at the
/// coordinates of vertices where several share one, so that edges of machined parts are
/// not cut beside. Triangles much smaller than a cell are not cut: all cells that they may
/// meet have a copy, which sticks out of none by more than an eighth of its longest side. What lies
/// in a cut's plane goes to the side on which the body is. The same for any parallel_for.
[[nodiscard]] SolidCells cut_into_cells(const mesh::Mesh& mesh, const Solid& solid,
                                        const DistanceField& field,
                                        const SolidCellOptions& options);

}  // namespace cdprep::convex
