// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <span>

#include "cells/cell_bounds.h"
#include "cells/tetra_cones.h"

namespace cdprep {

/// Returns the least key of a level.
inline std::uint32_t first_key_of(std::uint32_t level) noexcept {
    return 8U << (2 * level);
}

/// The part of a tetra-tree that a walk uses.
struct TetraDetail {
    std::uint32_t level = format::kMaxTetraLevel;  ///< cones of this level are leaves
    bool solid = false;                            ///< cones reach from the centre outwards
};

/// A model's tetra-tree in the form for CellWalk, without the triangles that hold its centre: no
/// cone lists those.
class TetraTreeCells {
public:
    static constexpr std::uint32_t kMostLevels = format::kMaxTetraLevel + 1;
    static constexpr bool kOriented = true;

    struct Cell {
        std::uint32_t node;
    };

    explicit TetraTreeCells(const Model& model, const TetraDetail& detail = {}) noexcept;

    [[nodiscard]] bool is_empty() const noexcept {
        return tree_ == nullptr || octants_ == 0;
    }
    [[nodiscard]] static Cell top() noexcept {
        return {kAboveRoots};
    }
    /// Returns the set of children, in the lanes where tetra_boxes has their boxes.
    [[nodiscard]] unsigned lanes(const Cell& cell) const noexcept {
        if (cell.node == kAboveRoots) return (1U << octants_) - 1;
        const format::TetraNode& node = nodes_[cell.node];
        assert((node.flags & format::tetra_inner) != 0 && node.count <= 4);
        return ((1U << node.count) - 1) << node.first % format::kTetraBoxStride;
    }
    [[nodiscard]] Cell child(const Cell& cell, unsigned lane) const noexcept {
        return {first_box(cell) * format::kTetraBoxStride + lane};
    }
    [[nodiscard]] bool is_leaf(const Cell& cell) const noexcept {
        assert(cell.node != kAboveRoots);
        const format::TetraNode& node = nodes_[cell.node];
        return (node.flags & format::tetra_inner) == 0 || node.key >= first_key_of(detail_.level);
    }
    [[nodiscard]] unsigned leaf_lanes(const Cell& cell) const noexcept {
        unsigned leaves = 0;
        for (unsigned rest = lanes(cell); rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<unsigned>(std::countr_zero(rest));
            if (is_leaf(child(cell, lane))) leaves |= 1U << lane;
        }
        return leaves;
    }
    [[nodiscard]] std::span<const std::uint32_t> references(const Cell& cell) const noexcept {
        return references_.subspan(nodes_[cell.node].first, nodes_[cell.node].count);
    }
    [[nodiscard]] StoredBounds stored_bounds(const Cell& cell) const noexcept {
        if (boxes_ == nullptr) return {};
        const std::uint32_t at = first_box(cell);
        return {boxes_ + at, oriented_ == nullptr ? nullptr : oriented_ + at};
    }
    void bound(const Cell& cell, MadeBounds& bounds) const noexcept;
    [[nodiscard]] unsigned lanes_listing(const Cell& cell, std::uint32_t triangle,
                                         const Corners& corners) const noexcept;

    /// Returns the triangles that hold the centre.
    [[nodiscard]] std::span<const std::uint32_t> at_centre() const noexcept {
        return tree_ == nullptr ? references_ : references_.first(tree_->centre_count);
    }
    [[nodiscard]] bool is_at_centre(std::uint32_t triangle) const noexcept {
        const auto numbers = at_centre();
        return std::any_of(numbers.begin(), numbers.end(), [&](std::uint32_t reference) {
            return (reference & ~format::kSharedReference) == triangle;
        });
    }

private:
    /// Returns the element of tetra_boxes that begins with a cell's first child, or shortly before
    /// it.
    [[nodiscard]] std::uint32_t first_box(const Cell& cell) const noexcept {
        return cell.node == kAboveRoots ? 0 : nodes_[cell.node].first / format::kTetraBoxStride;
    }

    TetraDetail detail_;
    const format::TetraTree* tree_;
    const format::TetraNode* nodes_;
    const format::BvhNode* boxes_;          ///< or null: none, or unusable for detail_.solid
    const format::OrientedNode* oriented_;  ///< or null
    std::span<const std::uint32_t> references_;
    std::array<double, 3> centre_;  ///< frame coordinates
    unsigned octants_ = 0;          ///< the number of octants with a node
};

}  // namespace cdprep
