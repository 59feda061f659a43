// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decompose/enclose/approximate_pieces.h"
#include "decompose/enclose/solid_cells.h"

namespace cdprep::convex {

/// What the hull of a piece has to hold.
struct PiecePoints {
    std::vector<Double3> points;
    std::vector<std::uint32_t> triangles;  ///< with a fragment in the piece; ascending
    std::uint64_t fragments = 0;           ///< that are this piece's to hold
};

/// Points of a cell that lie farthest in many directions: its hull but for little.
[[nodiscard]] std::vector<Double3> extreme_points(const SolidCells& cells, const SolidCell& cell);

/// For pieces as sets of cells, points whose hulls hold the cells. A cell that is in
/// several pieces is left to the largest; a triangle whose fragments are all in one piece is
/// held by its corners, a fragment otherwise by the boxes in which its corners lie.
[[nodiscard]] std::vector<PiecePoints> gather_points(
    const SolidCells& cells, const mesh::Mesh& mesh,
    std::span<const std::vector<std::uint32_t>> pieces);

/// Counts how many points are outside of a hull, exactly. Tests of corners of boxes around
/// points count as such of points.
[[nodiscard]] EnclosureProof prove_points(const ConvexHull& hull, std::span<const Double3> points);

}  // namespace cdprep::convex
