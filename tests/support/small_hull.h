// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/convex_points.h"

namespace cdprep::test {

/// The search for support points: hill climbing along edges, or a test of every point.
enum class Edges : std::uint8_t { none, exact };

/// A convex hull in memory, with all data for ConvexPoints.
class SmallHull {
public:
    /// Makes the hull of at least one point. Adds one point after the other to a polytope of
    /// triangles, with exact signs: O(n f). Points on a face or an edge of the hull may stay. If
    /// all points lie in one plane, all stay and there are no edges.
    explicit SmallHull(std::span<const Double3> points, Edges edges = Edges::exact);

    [[nodiscard]] ConvexPoints view() const;
    [[nodiscard]] const std::vector<Double3>& points() const {
        return points_;
    }
    /// Returns the triangles, counter-clockwise from outside; none if the points lie in one plane.
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const {
        return triangles_;
    }

private:
    void drop_inner_points();
    void list_neighbours();
    void list_starts();

    std::vector<Double3> points_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<format::HullBlock> blocks_;
    Double3 reach_{};
    std::vector<std::uint32_t> begins_;
    std::vector<std::uint32_t> neighbours_;
    std::vector<std::uint32_t> starts_;
};

/// Returns the corners of a box with these half extents around the origin.
[[nodiscard]] std::vector<Double3> box_corners(double x, double y, double z);

}  // namespace cdprep::test
