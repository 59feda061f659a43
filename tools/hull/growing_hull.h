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

/// A convex hull that adds points one by one, exactly. It serves the few points of a patch,
/// thousands of times a second. For many points use convex_hull().
class GrowingHull {
public:
    static constexpr std::uint32_t kDead = UINT32_MAX;

    /// A triangle of the boundary, counter-clockwise from outside; never degenerate.
    struct Facet {
        std::array<std::uint32_t, 3> corner;  ///< indices into points(); kDead first: unused
        std::array<std::uint32_t, 3> across;  ///< the facet across the edge that starts at corner k
    };

    /// Builds the hull: starts with four points that are not coplanar, and adds the others.
    /// Points must be distinct. Returns false, with an empty hull, if all points are coplanar.
    bool build(std::span<const Double3> points);

    /// Adopts a known hull. `triangles` are a closed surface, counter-clockwise from outside, as
    /// indices into `points`.
    void adopt(std::span<const Double3> points,
               std::span<const std::array<std::uint32_t, 3>> triangles);

    /// Adds another point.
    void add(const Double3& point);

    /// The points in the order of their addition, inner points included.
    [[nodiscard]] const std::vector<Double3>& points() const noexcept {
        return points_;
    }
    /// The facets; entries whose first corner is kDead are unused.
    [[nodiscard]] const std::vector<Facet>& facets() const noexcept {
        return facets_;
    }
    [[nodiscard]] bool empty() const noexcept {
        return facets_.empty();
    }

    /// Returns whether a point of the triangle lies strictly inside the hull. The triangle may
    /// be degenerate. Exact. Usually O(1); O(points squared) in close cases.
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
    // Scratch memory of take_in().
    std::vector<std::uint8_t> visible_;
    std::vector<std::uint32_t> unused_;
    std::vector<std::uint32_t> ring_;
    std::vector<std::uint32_t> facet_from_;
};

}  // namespace cdprep::convex
