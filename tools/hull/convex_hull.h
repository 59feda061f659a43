// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/geometry.h"

namespace cdprep::convex {

using format::Double3;

/// A convex hull. Dimension 3 is a closed polyhedron, 2 a polygon with both sides, 1 a segment,
/// 0 a point, and -1 the hull of nothing.
struct ConvexHull {
    int dimension = -1;
    std::vector<Double3> points;         ///< extreme points, by ascending number
    std::vector<std::uint32_t> numbers;  ///< in the input; empty: they are no input points
    /// Triangles of dimensions 2 and 3, as indices into `points`. They are counter-clockwise
    /// seen from outside, least index first, and sorted within each group. None is degenerate.
    std::vector<std::array<std::uint32_t, 3>> facets;
    /// The first facet of each maximal coplanar face, which is a fan; at the end the number of
    /// facets.
    std::vector<std::uint32_t> groups = {0};
};

/// Returns the exact convex hull. Its points are the input points that are not convex
/// combinations of others. Of several equal points it uses the first.
///
/// Except for the numbers, the result is the same for every order of the input. Coplanar faces
/// are split into a fan around their lexicographically least point. The back of a polygon has
/// its fan around the point before it, so that it is a closed surface too. Facets of a group are
/// sorted, and groups are in the order of their first facet.
///
/// Accepts any number of points, also equal, collinear and coplanar ones. Coordinates must be
/// finite. Expected O(n log n), and little more than O(n) if most points are well inside. Only
/// the search for these inner points uses the threads of `run`.
[[nodiscard]] ConvexHull convex_hull(std::span<const Double3> points, ParallelFor run = serial_for);

}  // namespace cdprep::convex
