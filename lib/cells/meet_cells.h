// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "cells/cell_bounds.h"
#include "cells/node_lists.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// A leaf cell and its list.
struct MetCell {
    std::uint32_t node;
    std::span<const std::uint32_t> references;
    const format::BvhNode* boxes;  ///< its box is one of these
    unsigned lane;
};

/// A box around the intersection of two cells, in A's frame, laid out for the kernels as one box of
/// eight. Everything that two triangles share there lies in it.
class CommonBox {
public:
    CommonBox(const MetCell& a, const MetCell& b, const PlacedBoxes& placed) noexcept {
        std::array<double, 3> centre{};
        std::array<double, 3> half{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double lower = double{b.boxes->lower[i][b.lane]} * placed.scale_b;
            const double upper = double{b.boxes->upper[i][b.lane]} * placed.scale_b;
            centre[i] = (lower + upper) / 2;
            half[i] = (upper - lower) / 2;
        }
        // The kernels' slack covers the rounding of all that is float here.
        const double unscaled = 1 / placed.scale_a;
        for (std::size_t i = 0; i < 3; ++i) {
            const double* r = &placed.rotation[3 * i];
            const double at =
                r[0] * centre[0] + r[1] * centre[1] + r[2] * centre[2] + placed.shift[i];
            const double reach = std::fabs(r[0]) * half[0] + std::fabs(r[1]) * half[1] +
                                 std::fabs(r[2]) * half[2] + 2 * double{placed.placement.slack};
            row_[i][0] =
                std::max(static_cast<float>((at - reach) * unscaled), a.boxes->lower[i][a.lane]);
            row_[3 + i][0] =
                std::min(static_cast<float>((at + reach) * unscaled), a.boxes->upper[i][a.lane]);
        }
    }

    /// Returns the box as kernels::BoxChoice::around_a.
    [[nodiscard]] const float* rows() const noexcept {
        return row_[0].data();
    }
    /// Returns which boxes of A reach this box. Rounding aside, no other box touches anything in
    /// it.
    [[nodiscard]] unsigned reached_by(const format::BvhNode& boxes) const noexcept {
        std::array<std::uint32_t, format::kBvhWidth> out{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float lower = row_[axis][0];
            const float upper = row_[3 + axis][0];
            for (std::size_t lane = 0; lane < format::kBvhWidth; ++lane) {
                out[lane] |= static_cast<std::uint32_t>(boxes.lower[axis][lane] > upper) |
                             static_cast<std::uint32_t>(boxes.upper[axis][lane] < lower);
            }
        }
        unsigned lanes = 0;
        for (unsigned lane = 0; lane < format::kBvhWidth; ++lane) lanes |= (out[lane] ^ 1) << lane;
        return lanes;
    }

private:
    std::array<std::array<float, format::kBvhWidth>, 6> row_;  ///< lane 0 is used
};

/// Tests the lists of two leaf cells against each other, by low nodes of the BVHs. The kernels
/// process a whole node or leaf in the time of one triangle. So pairs that other cells list too are
/// settled at the same time, once.
template <class Lists>
class MeetCells {
public:
    /// `met` may be null: then everything is tested each time.
    MeetCells(const Model& a, const Model& b, const PlacedBoxes& placed, Lists& lists_a,
              Lists& lists_b, MetNodes* met) noexcept
        : lists_a_(lists_a),
          lists_b_(lists_b),
          placed_(placed),
          nodes_a_(a.bvh().nodes.data() + a.bvh().shape.first[0]),
          nodes_b_(b.bvh().nodes.data() + b.bvh().shape.first[0]),
          met_(met) {
        if (!a.bvh().oriented.empty() && !b.bvh().oriented.empty()) {
            oriented_a_ = a.bvh().oriented.data() + a.bvh().shape.first[0];
            oriented_b_ = b.bvh().oriented.data() + b.bvh().shape.first[0];
        }
        lists_a_.begin(a);
        lists_b_.begin(b);
    }

    /// Returns false when `contacts` ended the query.
    template <class Contacts>
    bool operator()(const MetCell& a, const MetCell& b, std::uint64_t place,
                    Contacts& contacts) noexcept {
        const CommonBox common(a, b, placed_);
        for (std::uint32_t at_a = 0; at_a < a.references.size();) {
            const NodeList list_a = lists_a_.list(a.node, at_a, a.references);
            at_a = list_a.end;
            for (std::uint32_t at_b = 0; at_b < b.references.size();) {
                const NodeList list_b = lists_b_.list(b.node, at_b, b.references);
                at_b = list_b.end;
                if (!meet(common, list_a, list_b, place, contacts)) return false;
            }
        }
        return true;
    }

private:
    static constexpr std::uint32_t kFewNodes = 8;

    /// Returns the pairs of boxes that may touch in the intersection of the cells.
    [[nodiscard]] kernels::BoxPairs overlapping(const CommonBox& common, const format::BvhNode& a,
                                                unsigned lanes_a, const format::BvhNode& b,
                                                unsigned lanes_b) const noexcept {
        lanes_a &= common.reached_by(a);
        if (lanes_a == 0) return 0;
        kernels::BoxSizes sizes;
        return kernels::active().overlapping_boxes(
            placed_.placement, {a.lower[0].data(), nullptr}, {b.lower[0].data(), nullptr},
            {static_cast<std::uint8_t>(lanes_a), static_cast<std::uint8_t>(lanes_b), common.rows()},
            sizes);
    }

    template <class Contacts>
    bool meet(const CommonBox& common, const NodeList& list_a, const NodeList& list_b,
              std::uint64_t place, Contacts& contacts) const noexcept {
        kernels::BoxPairs blocks = 1;
        if (list_a.blocks + list_b.blocks > 2) {
            blocks = overlapping(common, *list_a.around, (1U << list_a.blocks) - 1, *list_b.around,
                                 (1U << list_b.blocks) - 1);
        }
        for (; blocks != 0; blocks &= blocks - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(blocks));
            if (!meet(common, list_a.block[bit % 8], list_b.block[bit / 8], place, contacts)) {
                return false;
            }
        }
        return true;
    }

    template <class Contacts>
    bool meet(const CommonBox& common, const NodeBlock& a, const NodeBlock& b, std::uint64_t place,
              Contacts& contacts) const noexcept {
        // Testing a few nodes once is faster than separating them in each pair of cells.
        const bool few = a.count * b.count <= kFewNodes;
        kernels::BoxPairs nodes = few ? lane_pairs(a.lanes(), b.lanes())
                                      : overlapping(common, a.boxes, a.lanes(), b.boxes, b.lanes());
        for (; nodes != 0; nodes &= nodes - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(nodes));
            if (!meet(a.node[bit % 8], b.node[bit / 8], place, contacts)) return false;
        }
        return true;
    }

    /// Tests the leaves of two nodes by all their bounds. The intersection of the cells does not
    /// matter here: the result holds for all cells.
    template <class Contacts>
    bool meet(const LowNode& a, const LowNode& b, std::uint64_t place,
              Contacts& contacts) const noexcept {
        // Where answers cannot be remembered, each place must bring what it lists.
        MetNodes* met = contacts.forgets() ? nullptr : met_;
        if (met != nullptr && met->holds(a.number, b.number)) return true;
        kernels::BoxSizes sizes;
        kernels::BoxPairs leaves = kernels::active().overlapping_boxes(
            placed_.placement, node_boxes(nodes_a_, oriented_a_, a.number),
            node_boxes(nodes_b_, oriented_b_, b.number), {a.leaves, b.leaves, nullptr}, sizes);
        for (; leaves != 0; leaves &= leaves - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(leaves));
            const LeafLanes leaf_a = {a.number * format::kBvhWidth + bit % 8, 0xff};
            const LeafLanes leaf_b = {b.number * format::kBvhWidth + bit / 8, 0xff};
            if (!contacts.add(leaf_a, leaf_b, place)) return false;
        }
        if (met != nullptr && !contacts.forgets()) met->add(a.number, b.number);
        return true;
    }
    static kernels::NodeBoxes node_boxes(const format::BvhNode* nodes,
                                         const format::OrientedNode* oriented,
                                         std::uint32_t node) noexcept {
        return {nodes[node].lower[0].data(),
                oriented == nullptr ? nullptr : oriented[node].axis[0][0].data()};
    }

    Lists& lists_a_;
    Lists& lists_b_;
    const PlacedBoxes& placed_;
    const format::BvhNode* nodes_a_;  ///< of level 0
    const format::BvhNode* nodes_b_;
    const format::OrientedNode* oriented_a_ = nullptr;  ///< or null, both or neither
    const format::OrientedNode* oriented_b_ = nullptr;
    MetNodes* met_;  ///< or null
};

}  // namespace cdprep
