// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

namespace cdprep::format {

/// The number of hull points that lie side by side in a HullBlock, for one SIMD operation.
inline constexpr std::size_t kHullLanes = 8;

/// Eight points of a convex hull, by coordinate: all x, then all y, then all z, in model units.
/// Lanes past a hull's last point repeat it. So a search for the farthest point need not know the
/// number of points.
struct alignas(64) HullBlock {
    std::array<std::array<double, kHullLanes>, 3> at;
};

static_assert(sizeof(HullBlock) == 192 && alignof(HullBlock) == 64);
static_assert(std::is_trivially_copyable_v<HullBlock> && std::is_standard_layout_v<HullBlock>);

}  // namespace cdprep::format
