// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstdint>

#include "cdprep/format/octree.h"
#include "core/moved_model.h"

namespace cdprep {

/// A cell of the finest level: numbers below 2^kOctreeBits, or clamped to them.
using CellPlace = std::array<std::uint32_t, 3>;

inline constexpr std::uint32_t kOctreeSteps = 1U << format::kOctreeBits;

/// Returns plane `i` of an axis, as format::OctreeGrid defines it. Rounds once.
inline double octree_plane(double origin, double step, std::uint32_t i) noexcept {
    return origin + static_cast<double>(i) * step;
}

using format::cells_below;
using format::code_of;
using format::level_of;

/// Returns the number of the half-open finest cell [plane i, plane i + 1) that holds x along one
/// axis, exactly. Outside the cube, returns the nearest cell. x must not be NaN.
inline std::uint32_t octree_cell(double origin, double step, double x) noexcept {
    const double guess = (x - origin) / step;
    if (!(guess > 0)) return 0;
    if (guess >= kOctreeSteps - 1) {
        // May round up past the last plane but one.
        const std::uint32_t last = kOctreeSteps - 1;
        return x >= octree_plane(origin, step, last) ? last : last - 1;
    }
    auto i = static_cast<std::uint32_t>(guess);
    // The quotient is rounded: at most one plane off.
    if (x < octree_plane(origin, step, i)) return i == 0 ? 0 : i - 1;
    if (x >= octree_plane(origin, step, i + 1)) ++i;
    return i;
}

inline CellPlace octree_cell(const format::OctreeGrid& grid, const Double3& p) noexcept {
    return {octree_cell(grid.origin.x, grid.step, p.x), octree_cell(grid.origin.y, grid.step, p.y),
            octree_cell(grid.origin.z, grid.step, p.z)};
}

/// Returns the closed box of a cell.
inline Box3 octree_box(const format::OctreeGrid& grid, const CellPlace& first,
                       std::uint32_t level) noexcept {
    assert(level <= format::kOctreeBits);
    const std::uint32_t steps = kOctreeSteps >> level;
    assert(first[0] + steps <= kOctreeSteps && first[1] + steps <= kOctreeSteps &&
           first[2] + steps <= kOctreeSteps);
    return {{octree_plane(grid.origin.x, grid.step, first[0]),
             octree_plane(grid.origin.y, grid.step, first[1]),
             octree_plane(grid.origin.z, grid.step, first[2])},
            {octree_plane(grid.origin.x, grid.step, first[0] + steps),
             octree_plane(grid.origin.y, grid.step, first[1] + steps),
             octree_plane(grid.origin.z, grid.step, first[2] + steps)}};
}

}  // namespace cdprep
