// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <span>

#include "cells/cell_bounds.h"
#include "cells/octree_cells.h"
#include "exact/triangle_box.h"

namespace cdprep {

/// A model's octree in the form for CellWalk.
class OctreeTree {
public:
    static constexpr std::uint32_t kMostLevels = format::kOctreeBits + 1;
    static constexpr bool kOriented = false;

    /// A node and its place.
    struct Cell {
        std::uint32_t node;
        std::uint32_t level;
        CellPlace first;
    };

    explicit OctreeTree(const Model& model) noexcept
        : grid_(model.octree().grid),
          nodes_(model.octree().nodes.data()),
          references_(model.octree().references),
          frame_(model),
          boxes_(model.octree().boxes.data()),
          is_empty_(grid_ == nullptr || model.octree().nodes.empty()) {}

    [[nodiscard]] bool is_empty() const noexcept {
        return is_empty_;
    }
    [[nodiscard]] static Cell top() noexcept {
        return {kAboveRoots, 0, {}};
    }
    /// Returns the set of children of a cell. Above the root it is one child, the root.
    [[nodiscard]] unsigned lanes(const Cell& cell) const noexcept {
        return cell.node == kAboveRoots ? 1 : nodes_[cell.node].count & 0xff;
    }
    [[nodiscard]] Cell child(const Cell& cell, unsigned lane) const noexcept {
        if (cell.node == kAboveRoots) return {0, 0, {}};
        Cell below{child_node(cell, lane), cell.level + 1, cell.first};
        const std::uint32_t half = kOctreeSteps >> below.level;
        for (std::size_t axis = 0; axis < 3; ++axis) below.first[axis] += half * (lane >> axis & 1);
        return below;
    }
    [[nodiscard]] bool is_leaf(const Cell& cell) const noexcept {
        assert(cell.node != kAboveRoots);
        return (nodes_[cell.node].count & format::kInnerNode) == 0;
    }
    /// Returns the set of children that are leaves.
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
    [[nodiscard]] Box3 box(const Cell& cell) const noexcept {
        return octree_box(*grid_, cell.first, cell.level);
    }
    /// Returns the planes between the children. Not for the cell above the root.
    [[nodiscard]] Double3 split(const Cell& cell) const noexcept {
        assert(cell.node != kAboveRoots);
        const std::uint32_t half = kOctreeSteps >> 1 >> cell.level;
        return {octree_plane(grid_->origin.x, grid_->step, cell.first[0] + half),
                octree_plane(grid_->origin.y, grid_->step, cell.first[1] + half),
                octree_plane(grid_->origin.z, grid_->step, cell.first[2] + half)};
    }
    [[nodiscard]] static StoredBounds stored_bounds(const Cell& /*cell*/) noexcept {
        return {};
    }
    void bound(const Cell& cell, MadeBounds& bounds) const noexcept {
        if (boxes_ != nullptr && cell.node != kAboveRoots) {
            return bound_by_boxes(boxes_ + nodes_[cell.node].first, lanes(cell), bounds.boxes);
        }
        const std::array<double, 3> origin = {grid_->origin.x, grid_->origin.y, grid_->origin.z};
        const std::uint32_t steps = kOctreeSteps >> cell.level;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto plane = [&](std::uint32_t i) {
                return frame_.frame(axis, octree_plane(origin[axis], grid_->step, i));
            };
            const std::uint32_t first = cell.first[axis];
            if (cell.node == kAboveRoots) {
                bound_root(axis, plane(0), plane(kOctreeSteps), bounds.boxes);
            } else {
                bound_octants(axis, {plane(first), plane(first + steps / 2), plane(first + steps)},
                              bounds.boxes);
            }
        }
    }
    /// Returns the set of children that list a triangle. No other child lists it.
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
    [[nodiscard]] std::uint32_t child_node(const Cell& cell, unsigned lane) const noexcept {
        const format::OctreeNode& node = nodes_[cell.node];
        assert((node.count >> lane & 1) != 0);
        return node.first + lanes_before(node.count & 0xff, lane);
    }

    const format::OctreeGrid* grid_;
    const format::OctreeNode* nodes_;
    std::span<const std::uint32_t> references_;
    FrameOf frame_;
    const format::CellBox* boxes_;  ///< or null
    bool is_empty_;
};

}  // namespace cdprep
