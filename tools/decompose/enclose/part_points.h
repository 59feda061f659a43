// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decompose/enclose/approximate_parts.h"
#include "decompose/enclose/solid_cells.h"

namespace cdprep::convex {

/// The points that the hull of a part must contain.
struct PartPoints {
    std::vector<Double3> points;
    std::vector<std::uint32_t> triangles;  ///< with a fragment in the part; ascending
    std::uint64_t fragments = 0;           ///< that this part has to contain
};

/// Adds the corners of the box that contains the place: usually one.
void add_corners(const Place& place, std::vector<Double3>& points);

/// Returns the points of a cell that lie farthest along many directions: nearly its hull.
[[nodiscard]] std::vector<Double3> extreme_points(const SolidCells& cells, const SolidCell& cell);

/// Returns, for parts given as sets of cells, points whose hulls contain the cells. A cell in
/// several parts belongs to the largest one. A triangle whose fragments are all in one part is
/// represented by its corners. Any other fragment is represented by the boxes in which its corners
/// lie.
[[nodiscard]] std::vector<PartPoints> gather_points(
    const SolidCells& cells, const mesh::Mesh& mesh,
    std::span<const std::vector<std::uint32_t>> parts);

/// Counts the points outside a hull, exactly. Tests of the corners of boxes around points count as
/// point tests.
[[nodiscard]] EnclosureProof prove_points(const ConvexHull& hull, std::span<const Double3> points);

}  // namespace cdprep::convex
