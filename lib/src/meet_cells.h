// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "cdprep/structure.h"
#include "cell_bounds.h"
#include "leaf_lists.h"
#include "workspace_storage.h"

namespace cdprep {

/// One leaf cell and what it lists.
struct MetCell {
    std::uint32_t node;
    std::span<const std::uint32_t> references;
    const format::BvhNode* boxes;  ///< its box is one of these
    unsigned lane;
};

/// A box around what two cells have in common, in A's frame, laid out as the kernels want a
/// box among eight: what two triangles share there lies in it.
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

    /// As kernels::BoxChoice::around_a.
    [[nodiscard]] const float* rows() const noexcept {
        return row_[0].data();
    }
    /// Which boxes of A reach it: rounding aside, none of those touches anything in it.
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

/// Holds what two leaf cells list against each other: the boxes of BVH leaves first, eight
/// by eight.
template <class Lists>
class MeetCells {
public:
    MeetCells(const Model& a, const Model& b, const PlacedBoxes& placed, LeafTest leaf_test,
              Lists& lists_a, Lists& lists_b) noexcept
        : lists_a_(lists_a),
          lists_b_(lists_b),
          placed_(placed),
          // The kernels take all eight triangles of a leaf in the time of one: what another
          // cell lists is settled on the way.
          every_lane_(leaf_test == LeafTest::guigue_devillers) {
        lists_a_.begin(a.nodes().data() + a.shape().first[0]);
        lists_b_.begin(b.nodes().data() + b.shape().first[0]);
    }

    /// False when `contacts` ended the question.
    template <class Contacts>
    bool operator()(const MetCell& a, const MetCell& b, std::uint64_t place,
                    Contacts& contacts) noexcept {
        const CommonBox common(a, b, placed_);
        for (std::uint32_t at_a = 0; at_a < a.references.size();) {
            const LeafList list_a = lists_a_.list(a.node, at_a, a.references);
            at_a = list_a.end;
            for (std::uint32_t at_b = 0; at_b < b.references.size();) {
                const LeafList list_b = lists_b_.list(b.node, at_b, b.references);
                at_b = list_b.end;
                if (!meet(common, list_a, list_b, place, contacts)) return false;
            }
        }
        return true;
    }

private:
    /// The pairs of boxes that may touch in what the cells have in common.
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
    [[nodiscard]] LeafLanes widened(LeafLanes leaf) const noexcept {
        if (every_lane_) leaf.lanes = 0xff;
        return leaf;
    }

    template <class Contacts>
    bool meet(const CommonBox& common, const LeafList& list_a, const LeafList& list_b,
              std::uint64_t place, Contacts& contacts) const noexcept {
        kernels::BoxPairs blocks = 1;
        if (list_a.blocks + list_b.blocks > 2) {
            blocks = overlapping(common, *list_a.around, (1U << list_a.blocks) - 1, *list_b.around,
                                 (1U << list_b.blocks) - 1);
        }
        for (; blocks != 0; blocks &= blocks - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(blocks));
            const LeafBlock& block_a = list_a.block[bit % 8];
            const LeafBlock& block_b = list_b.block[bit / 8];
            const kernels::BoxPairs leaves =
                overlapping(common, block_a.boxes, block_a.lanes(), block_b.boxes, block_b.lanes());
            if (!add_all(block_a, block_b, leaves, place, contacts)) return false;
        }
        return true;
    }

    template <class Contacts>
    bool add_all(const LeafBlock& a, const LeafBlock& b, kernels::BoxPairs pairs,
                 std::uint64_t place, Contacts& contacts) const noexcept {
        for (; pairs != 0; pairs &= pairs - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(pairs));
            if (!contacts.add(widened(a.leaf[bit % 8]), widened(b.leaf[bit / 8]), place)) {
                return false;
            }
        }
        return true;
    }

    Lists& lists_a_;
    Lists& lists_b_;
    const PlacedBoxes& placed_;
    bool every_lane_;
};

}  // namespace cdprep
