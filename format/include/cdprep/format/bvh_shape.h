// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/format/limits.h"

namespace cdprep::format {

/// The positions of each level's nodes in the node array. They follow from the triangle count
/// alone.
///
/// Level 0 is the lowest: its boxes contain leaves. The root is the only node of level `levels - 1`
/// and node 0 of the array. Without triangles there are no nodes.
struct BvhShape {
    std::uint32_t levels = 0;                          ///< 0 only if there are no triangles
    std::uint32_t leaf_count = 0;                      ///< ceil(triangles / 8)
    std::uint32_t node_count = 0;                      ///< nodes of all levels
    std::array<std::uint32_t, kMaxBvhLevels> first{};  ///< by level: index of its first node
    std::array<std::uint32_t, kMaxBvhLevels> count{};  ///< by level: number of its nodes

    /// Returns the number of used boxes of a node: 1 to 8. `node` is its index within the level.
    [[nodiscard]] constexpr std::uint32_t used_boxes(std::uint32_t level,
                                                     std::uint32_t node) const noexcept {
        const std::uint32_t below = level == 0 ? leaf_count : count[level - 1];
        const std::uint32_t rest = below - node * kBvhWidth;
        return rest < kBvhWidth ? rest : kBvhWidth;
    }
};

/// Returns the shape of the BVH over `triangle_count` triangles, at most kMaxTriangles.
[[nodiscard]] constexpr BvhShape bvh_shape(std::uint32_t triangle_count) noexcept {
    BvhShape shape;
    if (triangle_count == 0) return shape;
    shape.leaf_count = (triangle_count - 1) / kBvhWidth + 1;
    std::uint32_t below = shape.leaf_count;
    do {
        below = (below - 1) / kBvhWidth + 1;
        shape.count[shape.levels++] = below;
    } while (below > 1);
    for (std::uint32_t level = shape.levels; level-- > 0;) {
        shape.first[level] = shape.node_count;
        shape.node_count += shape.count[level];
    }
    return shape;
}

}  // namespace cdprep::format
