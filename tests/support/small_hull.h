// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/convex_points.h"

namespace cdprep::test {

/// Whether queries climb along edges or look at every point.
enum class Edges : std::uint8_t { none, exact };

/// A convex hull in memory, with all that ConvexPoints wants.
class SmallHull {
public:
    /// The hull of some points, at least one, by adding one after the other to a polytope
    /// of triangles with exact signs: O(n f). Points of a face or an edge of it may stay.
    /// All stay, and there are no edges, when the points lie in one plane.
    explicit SmallHull(std::span<const Double3> points, Edges edges = Edges::exact);

    [[nodiscard]] ConvexPoints view() const;
    [[nodiscard]] const std::vector<Double3>& points() const {
        return points_;
    }
    /// Counter-clockwise from outside; none when flat.
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

/// The corners of a box with these half extents around the origin.
[[nodiscard]] std::vector<Double3> box_corners(double x, double y, double z);

}  // namespace cdprep::test
