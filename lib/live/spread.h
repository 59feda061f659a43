// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "build/frame_map.h"
#include "cdprep/format/limits.h"

namespace cdprep {

/// A triangle to be placed in a leaf.
struct SpreadItem {
    std::array<float, 3> middle;  ///< three times the mean of its corners
    std::uint32_t id;             ///< decides between equal middles
    std::uint32_t from;           ///< of the caller
};

/// Returns SpreadItem::middle of a triangle, in the frame.
[[nodiscard]] inline std::array<float, 3> middle_of(const build::FrameMap& map,
                                                    const format::Double3& a,
                                                    const format::Double3& b,
                                                    const format::Double3& c) noexcept {
    const auto at = [&](double x, double y, double z, std::size_t axis) {
        return static_cast<float>(map.near(x, axis) + map.near(y, axis) + map.near(z, axis));
    };
    return {at(a.x, b.x, c.x, 0), at(a.y, b.y, c.y, 1), at(a.z, b.z, c.z, 2)};
}

/// How items are distributed over leaves.
enum class Fill : std::uint8_t {
    even,  ///< equal numbers, up to one
    full,  ///< eight in each leaf but the last that has any
};

/// Returns the index of the first item that spread() gives to a leaf.
[[nodiscard]] constexpr std::size_t first_in_leaf(std::size_t items, std::uint32_t leaf,
                                                  std::uint32_t leaves, Fill fill) noexcept {
    if (fill == Fill::even) return static_cast<std::size_t>(std::uint64_t{items} * leaf / leaves);
    return std::min(items, std::size_t{leaf} * format::kBvhWidth);
}

/// Sorts items so that those of each leaf of a subtree are consecutive and near each other. Within
/// a leaf, items are sorted by id. The result depends only on the set of items. Splits along the
/// longest axis, between whole children. Takes O(n log n) time.
void spread(std::span<SpreadItem> items, std::uint32_t leaves, Fill fill) noexcept;

}  // namespace cdprep
