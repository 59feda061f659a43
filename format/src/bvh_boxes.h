// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/portable.h"
#include "section_view.h"

namespace cdprep::format {

/// Returns whether a used box lies in the frame and does not end before it begins.
inline bool is_bvh_box(const BvhNode& node, std::uint32_t box) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float lower = node.lower[axis][box];
        const float upper = node.upper[axis][box];
        if (!(lower >= -1 && lower <= upper && upper <= 1)) return false;
    }
    return true;
}

/// Returns whether the numbers of an unused box lie in the frame. They may get into sums.
inline bool is_unused_box(const BvhNode& node, std::uint32_t box) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float lower = node.lower[axis][box];
        const float upper = node.upper[axis][box];
        if (!(lower >= -1 && lower <= 1 && upper >= -1 && upper <= 1)) return false;
    }
    return true;
}

/// As is_bvh_box() for all boxes of a node: a loop without branches, which compilers vectorise.
inline bool are_bvh_boxes(const BvhNode& node) noexcept {
    constexpr std::size_t kLowers = std::size_t{3} * kBvhWidth;
    const auto numbers = bit_cast<std::array<float, 2 * kLowers>>(node);
    std::uint32_t bad = 0;
    for (std::size_t i = 0; i < kLowers; ++i) {
        const float lower = numbers[i], upper = numbers[kLowers + i];
        bad |= static_cast<std::uint32_t>(!(lower >= -1)) |
               static_cast<std::uint32_t>(!(lower <= upper)) |
               static_cast<std::uint32_t>(!(upper <= 1));
    }
    return bad == 0;
}

/// Finds a box of a BVH that ends before it begins or leaves the frame. There must be as many nodes
/// as the shape has.
inline std::optional<Damage> find_bad_bvh_box(const SectionView<BvhNode>& nodes,
                                              const BvhShape& shape) noexcept {
    assert(nodes.count() == shape.node_count);
    for (std::uint32_t level = 0; level < shape.levels; ++level) {
        for (std::uint32_t i = 0; i < shape.count[level]; ++i) {
            const std::uint32_t index = shape.first[level] + i;
            const BvhNode node = nodes[index];
            if (are_bvh_boxes(node)) continue;
            const std::uint32_t used = shape.used_boxes(level, i);
            for (std::uint32_t box = 0; box < kBvhWidth; ++box) {
                if (box < used ? is_bvh_box(node, box) : is_unused_box(node, box)) continue;
                return nodes.damage(DamageKind::bad_box, index, box, 0);
            }
        }
    }
    return std::nullopt;
}

}  // namespace cdprep::format
