// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

namespace cdprep::format {

/// Points of a hull side by side, for one vector operation each.
inline constexpr std::size_t kHullLanes = 8;

/// Eight points of a convex hull, coordinate by coordinate: x of all, then y, then z, in
/// model units. Lanes past a hull's last point repeat it, so that a search for the
/// farthest point need not know how many there are.
struct alignas(64) HullBlock {
    std::array<std::array<double, kHullLanes>, 3> at;
};

static_assert(sizeof(HullBlock) == 192 && alignof(HullBlock) == 64);
static_assert(std::is_trivially_copyable_v<HullBlock> && std::is_standard_layout_v<HullBlock>);

}  // namespace cdprep::format
