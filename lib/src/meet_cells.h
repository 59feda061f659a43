// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "cell_bounds.h"
#include "cell_contacts.h"

namespace cdprep {

/// Eight BVH leaves and the boxes around them.
struct LeafBlock {
    format::BvhNode boxes;
    std::array<LeafLanes, format::kBvhWidth> leaf;
    std::uint32_t count = 0;
};

/// The boxes around the leaves of a model, as its BVH has them.
class LeafBoxes {
public:
    explicit LeafBoxes(const Model& model) noexcept
        : nodes_(model.nodes().data() + model.shape().first[0]) {}

    void add_to(LeafBlock& block, const LeafLanes& leaf) const noexcept {
        const format::BvhNode& node = nodes_[leaf.leaf / format::kBvhWidth];
        const std::uint32_t box = leaf.leaf % format::kBvhWidth;
        const std::uint32_t lane = block.count++;
        block.leaf[lane] = leaf;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block.boxes.lower[axis][lane] = node.lower[axis][box];
            block.boxes.upper[axis][lane] = node.upper[axis][box];
        }
    }

private:
    const format::BvhNode* nodes_;
};

/// One leaf cell: what it lists, and its box: one of eight.
struct MetCell {
    std::span<const std::uint32_t> references;
    const format::BvhNode* boxes;
    unsigned lane;
};

/// Holds what two leaf cells list against each other: the boxes of BVH leaves first, eight
/// by eight.
class MeetCells {
public:
    MeetCells(const Model& a, const Model& b, const PlacedBoxes& placed, LeafTest leaf_test,
              QueryCounts* counts) noexcept
        : boxes_a_(a),
          boxes_b_(b),
          placed_(placed),
          // The kernels take all eight triangles of a leaf in the time of one: what another
          // cell lists is settled on the way.
          every_lane_(leaf_test == LeafTest::guigue_devillers),
          counts_(counts) {}

    /// False when `contacts` ended the question.
    template <class Contacts>
    bool operator()(const MetCell& a, const MetCell& b, std::uint64_t place,
                    Contacts& contacts) noexcept {
        if (counts_ != nullptr) ++counts_->cell_pairs;
        LeavesOf leaves_a(a.references);
        for (bool more = true; more;) {
            more = take_some_of_a(leaves_a, b);
            if (!meet_b(a, b, place, contacts)) return false;
        }
        return true;
    }

private:
    /// Most blocks of A that are held at once.
    static constexpr std::size_t kMostBlocks = 32;

    static unsigned lanes_of(const LeafBlock& block) noexcept {
        return (1U << block.count) - 1;
    }
    [[nodiscard]] kernels::BoxPairs overlapping(const format::BvhNode& a, unsigned lanes_a,
                                                const format::BvhNode& b,
                                                unsigned lanes_b) const noexcept {
        kernels::BoxSizes sizes;
        return kernels::active().overlapping_boxes(
            placed_.placement, {a.lower[0].data(), nullptr}, {b.lower[0].data(), nullptr},
            {static_cast<std::uint8_t>(lanes_a), static_cast<std::uint8_t>(lanes_b), nullptr},
            sizes);
    }

    [[nodiscard]] LeafLanes widened(LeafLanes leaf) const noexcept {
        if (every_lane_) leaf.lanes = 0xff;
        return leaf;
    }
    static bool fill(LeavesOf& leaves, const LeafBoxes& boxes, LeafBlock& block) noexcept {
        LeafLanes leaf{};
        block.count = 0;
        while (block.count < format::kBvhWidth) {
            if (!leaves.next(leaf)) return false;
            boxes.add_to(block, leaf);
        }
        return true;
    }
    /// Keeps some lanes of a block, in order.
    static void keep(LeafBlock& block, unsigned lanes) noexcept {
        std::uint32_t kept = 0;
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            block.leaf[kept] = block.leaf[lane];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.boxes.lower[axis][kept] = block.boxes.lower[axis][lane];
                block.boxes.upper[axis][kept] = block.boxes.upper[axis][lane];
            }
            ++kept;
        }
        block.count = kept;
    }

    /// Gathers leaves of A that come near B's cell; returns whether there are more.
    bool take_some_of_a(LeavesOf& leaves, const MetCell& b) noexcept {
        blocks_ = 0;
        bool more = true;
        while (more && blocks_ < kMostBlocks) {
            LeafBlock& block = block_[blocks_];
            more = fill(leaves, boxes_a_, block);
            if (block.count == 0) break;
            keep(block, kernels::boxes_of_a(
                            overlapping(block.boxes, lanes_of(block), *b.boxes, 1U << b.lane)));
            if (block.count != 0) ++blocks_;
        }
        return more;
    }

    template <class Contacts>
    bool meet_b(const MetCell& a, const MetCell& b, std::uint64_t place,
                Contacts& contacts) noexcept {
        if (blocks_ == 0) return true;
        LeavesOf leaves(b.references);
        LeafBlock block_b;
        for (bool more = true; more;) {
            more = fill(leaves, boxes_b_, block_b);
            if (block_b.count == 0) break;
            keep(block_b, kernels::boxes_of_b(overlapping(*a.boxes, 1U << a.lane, block_b.boxes,
                                                          lanes_of(block_b))));
            if (block_b.count == 0) continue;
            for (std::size_t i = 0; i < blocks_; ++i) {
                if (!meet_blocks(block_[i], block_b, place, contacts)) return false;
            }
        }
        return true;
    }

    template <class Contacts>
    bool meet_blocks(const LeafBlock& a, const LeafBlock& b, std::uint64_t place,
                     Contacts& contacts) const noexcept {
        kernels::BoxPairs pairs = overlapping(a.boxes, lanes_of(a), b.boxes, lanes_of(b));
        for (; pairs != 0; pairs &= pairs - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(pairs));
            const LeafLanes leaf_a = widened(a.leaf[bit % 8]);
            const LeafLanes leaf_b = widened(b.leaf[bit / 8]);
            if (!contacts.add(leaf_a, leaf_b, place)) return false;
        }
        return true;
    }

    LeafBoxes boxes_a_;
    LeafBoxes boxes_b_;
    const PlacedBoxes& placed_;
    bool every_lane_;
    QueryCounts* counts_;
    std::array<LeafBlock, kMostBlocks> block_;  ///< of A
    std::size_t blocks_ = 0;
};

}  // namespace cdprep
