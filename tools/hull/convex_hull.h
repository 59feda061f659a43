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

/// A convex hull: of dimension 3 a closed polyhedron, 2 a polygon seen from both
/// sides, 1 a segment, 0 a point; -1 of nothing.
struct ConvexHull {
    int dimension = -1;
    std::vector<Double3> points;         ///< extreme points, in order of their numbers
    std::vector<std::uint32_t> numbers;  ///< of the input points they are; empty: none of them
    /// Triangles of dimensions 2 and 3, numbers into `points`, counter-clockwise seen
    /// from outside, the least number first; sorted by group. None is degenerate.
    std::vector<std::array<std::uint32_t, 3>> facets;
    /// First facet of each maximal coplanar face, which is a fan; then the number of facets.
    std::vector<std::uint32_t> groups = {0};
};

/// Returns the convex hull, exactly: its points are those input points that are no
/// convex combination of others. Of equal points the first one stands for all.
///
/// The same for every order of the input, up to the numbers: coplanar faces are split
/// into the fan around their lexicographically least point (the back of a polygon: around
/// the one before it, so that it is a closed surface too), facets of a group are sorted,
/// and groups stand in order of their first facet. Any number of points, equal,
/// collinear and coplanar ones too. Coordinates must be finite. Expected O(n log n), and
/// little more than O(n) where most points are well inside; only finding out which those
/// are uses the threads of `run`.
[[nodiscard]] ConvexHull convex_hull(std::span<const Double3> points, ParallelFor run = serial_for);

}  // namespace cdprep::convex
