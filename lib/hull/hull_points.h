// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "cdprep/advanced/convex_points.h"

namespace cdprep {

/// Returns ConvexPoints::point(). Inline, for use inside queries, which have set the floating-point
/// environment.
[[nodiscard]] inline Double3 hull_point(const ConvexPoints& points, std::uint32_t number) noexcept {
    if (points.corners.empty()) {
        const auto& at = points.blocks[number / format::kHullLanes].at;
        const std::size_t lane = number % format::kHullLanes;
        return {at[0][lane], at[1][lane], at[2][lane]};
    }
    const std::uint32_t corner = points.corners[number];
    if (points.floats.empty()) return points.doubles[corner];
    const format::Float3& p = points.floats[corner];
    return {p.x, p.y, p.z};
}

/// Sets a point of some blocks.
inline void set_hull_point(std::span<format::HullBlock> blocks, std::size_t number,
                           const Double3& p) noexcept {
    auto& at = blocks[number / format::kHullLanes].at;
    const std::size_t lane = number % format::kHullLanes;
    at[0][lane] = p.x;
    at[1][lane] = p.y;
    at[2][lane] = p.z;
}

/// Returns direction_cell(), under the same conditions.
[[nodiscard]] inline std::uint32_t cell_of_direction(const Double3& direction) noexcept {
    const std::array<double, 3> d = {direction.x, direction.y, direction.z};
    std::uint32_t axis = std::fabs(d[1]) > std::fabs(d[0]) ? 1 : 0;
    if (std::fabs(d[2]) > std::fabs(d[axis])) axis = 2;
    const double most = std::fabs(d[axis]);
    const auto cell = [&](double x) {
        constexpr double kHalf = kDirectionCells / 2.0;
        const double at = most > 0 ? x / most * kHalf + kHalf : kHalf;
        return std::min(static_cast<std::uint32_t>(at), kDirectionCells - 1);
    };
    const std::uint32_t face = 2 * axis + (d[axis] < 0 ? 1 : 0);
    return (face * kDirectionCells + cell(d[(axis + 2) % 3])) * kDirectionCells +
           cell(d[(axis + 1) % 3]);
}

}  // namespace cdprep
