// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <span>

#include "cells/cell_bounds.h"
#include "core/moved_model.h"
#include "exact/triangle_box.h"

namespace cdprep {

/// A model's octree with split points of its own, in the form for CellWalk.
class AdaptiveOctreeTree {
public:
    static constexpr std::uint32_t kMostLevels = format::kOctreeBits + 1;
    static constexpr bool kOriented = false;

    /// A node and its box in model coordinates.
    struct Cell {
        std::uint32_t node;
        std::array<double, 3> lower;
        std::array<double, 3> upper;
    };

    explicit AdaptiveOctreeTree(const Model& model) noexcept
        : tree_(model.adaptive_octree().tree),
          nodes_(model.adaptive_octree().nodes.data()),
          references_(model.adaptive_octree().references),
          frame_(model),
          boxes_(model.adaptive_octree().boxes.data()),
          is_empty_(tree_ == nullptr || model.adaptive_octree().nodes.empty()) {}

    [[nodiscard]] bool is_empty() const noexcept {
        return is_empty_;
    }
    [[nodiscard]] Cell top() const noexcept {
        const Double3& lower = tree_->lower;
        const Double3& upper = tree_->upper;
        return {kAboveRoots, {lower.x, lower.y, lower.z}, {upper.x, upper.y, upper.z}};
    }
    [[nodiscard]] unsigned lanes(const Cell& cell) const noexcept {
        return cell.node == kAboveRoots ? 1 : nodes_[cell.node].count & 0xff;
    }
    [[nodiscard]] Cell child(const Cell& cell, unsigned lane) const noexcept {
        if (cell.node == kAboveRoots) return {0, cell.lower, cell.upper};
        Cell below{child_node(cell, lane), cell.lower, cell.upper};
        const std::array<double, 3> split = split_of(cell);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ((lane >> axis & 1) != 0 ? below.lower : below.upper)[axis] = split[axis];
        }
        return below;
    }
    [[nodiscard]] bool is_leaf(const Cell& cell) const noexcept {
        assert(cell.node != kAboveRoots);
        return (nodes_[cell.node].count & format::kInnerNode) == 0;
    }
    [[nodiscard]] unsigned leaf_lanes(const Cell& cell) const noexcept {
        unsigned leaves = 0;
        for (unsigned rest = lanes(cell); rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<unsigned>(std::countr_zero(rest));
            const std::uint32_t node = cell.node == kAboveRoots ? 0 : child_node(cell, lane);
            if ((nodes_[node].count & format::kInnerNode) == 0) leaves |= 1U << lane;
        }
        return leaves;
    }
    [[nodiscard]] std::span<const std::uint32_t> references(const Cell& cell) const noexcept {
        assert(is_leaf(cell));
        return references_.subspan(nodes_[cell.node].first, nodes_[cell.node].count);
    }
    [[nodiscard]] static Box3 box(const Cell& cell) noexcept {
        return {{cell.lower[0], cell.lower[1], cell.lower[2]},
                {cell.upper[0], cell.upper[1], cell.upper[2]}};
    }
    /// Returns the planes between the children. Not for the cell above the root.
    [[nodiscard]] Double3 split(const Cell& cell) const noexcept {
        assert(cell.node != kAboveRoots);
        return nodes_[cell.node].split;
    }
    [[nodiscard]] static StoredBounds stored_bounds(const Cell& /*cell*/) noexcept {
        return {};
    }
    void bound(const Cell& cell, MadeBounds& bounds) const noexcept {
        const bool is_top = cell.node == kAboveRoots;
        if (boxes_ != nullptr && !is_top) {
            return bound_by_boxes(boxes_ + nodes_[cell.node].first, lanes(cell), bounds.boxes);
        }
        const std::array<double, 3> split = is_top ? cell.lower : split_of(cell);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double lower = frame_.frame(axis, cell.lower[axis]);
            const double upper = frame_.frame(axis, cell.upper[axis]);
            if (is_top) {
                bound_root(axis, lower, upper, bounds.boxes);
            } else {
                bound_octants(axis, {lower, frame_.frame(axis, split[axis]), upper}, bounds.boxes);
            }
        }
    }
    [[nodiscard]] unsigned lanes_listing(const Cell& cell, std::uint32_t /*triangle*/,
                                         const Corners& corners) const noexcept {
        unsigned listing = 0;
        for (unsigned rest = lanes(cell); rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<unsigned>(std::countr_zero(rest));
            if (triangle_touches_box(corners, box(child(cell, lane)))) listing |= 1U << lane;
        }
        return listing;
    }

private:
    [[nodiscard]] std::array<double, 3> split_of(const Cell& cell) const noexcept {
        const Double3& split = nodes_[cell.node].split;
        return {split.x, split.y, split.z};
    }
    [[nodiscard]] std::uint32_t child_node(const Cell& cell, unsigned lane) const noexcept {
        const format::AdaptiveOctreeNode& node = nodes_[cell.node];
        assert((node.count >> lane & 1) != 0);
        return node.first + lanes_before(node.count & 0xff, lane);
    }

    const format::AdaptiveOctree* tree_;
    const format::AdaptiveOctreeNode* nodes_;
    std::span<const std::uint32_t> references_;
    FrameOf frame_;
    const format::CellBox* boxes_;  ///< or null
    bool is_empty_;
};

}  // namespace cdprep
