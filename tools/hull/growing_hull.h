// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/exact/triangles.h"

namespace cdprep::convex {

using format::Double3;

/// A convex hull that takes in one point after the other, exactly: for the few points of a
/// patch, thousands of times a second. convex_hull() is for many points.
class GrowingHull {
public:
    static constexpr std::uint32_t kDead = UINT32_MAX;

    /// A triangle of the boundary, counter-clockwise from outside; none is degenerate.
    struct Facet {
        std::array<std::uint32_t, 3> corner;  ///< numbers into points(); kDead first: unused
        std::array<std::uint32_t, 3> across;  ///< the facet beyond the edge from corner k on
    };

    /// Begins with four of the points that are in no plane, and adds the others. Points may
    /// not be equal. Returns false, and is empty, when all are in one plane.
    bool build(std::span<const Double3> points);

    /// Takes over a hull that is known: triangles counter-clockwise from outside, a closed
    /// surface, numbers into `points`.
    void adopt(std::span<const Double3> points,
               std::span<const std::array<std::uint32_t, 3>> triangles);

    /// Takes in another point.
    void add(const Double3& point);

    /// Points in the order they came, those inside too.
    [[nodiscard]] const std::vector<Double3>& points() const noexcept {
        return points_;
    }
    /// Those whose first corner is kDead are none.
    [[nodiscard]] const std::vector<Facet>& facets() const noexcept {
        return facets_;
    }
    [[nodiscard]] bool empty() const noexcept {
        return facets_.empty();
    }

    /// True when a point of the triangle, which may be degenerate, lies strictly inside.
    /// Exact. Mostly O(1), O(points squared) where it is close.
    [[nodiscard]] bool has_inside(const Corners& triangle) const;

private:
    [[nodiscard]] bool find_start(std::array<std::uint32_t, 4>& start) const;
    void begin_with(const std::array<std::uint32_t, 4>& start);
    void take_in(std::uint32_t point);
    [[nodiscard]] int side(const Facet& facet, const Double3& p) const;
    [[nodiscard]] bool is_parted_by_facet(const Corners& triangle, bool& has_corner_inside) const;
    [[nodiscard]] bool is_parted_by_plane(const Corners& triangle) const;
    [[nodiscard]] bool is_parted_at_hull_edge(const Corners& triangle) const;
    [[nodiscard]] bool is_parted_at_triangle_edge(const Corners& triangle) const;

    std::vector<Double3> points_;
    std::vector<Facet> facets_;
    // Scratch of take_in().
    std::vector<std::uint8_t> visible_;
    std::vector<std::uint32_t> unused_;
    std::vector<std::uint32_t> ring_;
    std::vector<std::uint32_t> facet_from_;
};

}  // namespace cdprep::convex
