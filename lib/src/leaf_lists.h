// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "cdprep/format/geometry.h"
#include "cdprep/format/octree.h"

namespace cdprep {

/// Some triangles of a BVH leaf.
struct LeafLanes {
    std::uint32_t leaf;
    std::uint8_t lanes;  ///< bit set
};

/// Eight BVH leaves and the boxes around them.
struct alignas(64) LeafBlock {
    format::BvhNode boxes;
    std::array<LeafLanes, format::kBvhWidth> leaf;
    std::uint32_t count;

    [[nodiscard]] unsigned lanes() const noexcept {
        return (1U << count) - 1;
    }
};

/// A part of what a cell lists: at most eight blocks, and the boxes around those.
struct LeafList {
    const LeafBlock* block;
    const format::BvhNode* around;
    std::uint32_t blocks;
    std::uint32_t end;  ///< one past its last reference
};

/// What leaf cells of one model list, by BVH leaves, with the boxes around those. A walk
/// comes to a cell many times in short succession: the last kSlots lists are kept.
template <std::size_t kSlots>
class LeafLists {
public:
    /// For other models, or another tree of them. `boxes` are of level 0 of the BVH.
    void begin(const format::BvhNode* boxes) noexcept {
        boxes_ = boxes;
        ++question_;
    }

    /// As many of the references of cell `node` as one list takes, from `begin` on; they
    /// rise. Valid until the next call.
    [[nodiscard]] LeafList list(std::uint32_t node, std::uint32_t begin,
                                std::span<const std::uint32_t> references) noexcept {
        Slot& slot = slots_[(node + begin) % kSlots];
        const bool is_same = slot.question == question_ && slot.node == node && slot.begin == begin;
        if (!is_same || written_ - slot.written > kBlocks) {
            // A list does not go round the end.
            const std::uint64_t rest = kBlocks - written_ % kBlocks;
            if (rest < kMostBlocks) written_ += rest;
            slot.question = question_;
            slot.written = written_;
            slot.node = node;
            slot.begin = begin;
            fill(slot, references);
        }
        return {&block_[slot.written % kBlocks], &slot.around, slot.blocks, slot.end};
    }

private:
    static constexpr std::size_t kMostBlocks = format::kBvhWidth;  ///< of a list
    // Most lists are of two blocks or fewer.
    static constexpr std::size_t kBlocks = kSlots == 1 ? kMostBlocks : 2 * kSlots;

    struct Slot {
        std::uint64_t question = 0;
        std::uint64_t written;  ///< when it began: good until kBlocks more were written
        std::uint32_t node;
        std::uint32_t begin;
        std::uint32_t end;
        std::uint32_t blocks;
        format::BvhNode around;
    };

    void fill(Slot& slot, std::span<const std::uint32_t> references) noexcept {
        LeafBlock* block = &block_[slot.written % kBlocks];
        slot.blocks = 0;
        std::size_t at = slot.begin;
        while (at < references.size() && slot.blocks < kMostBlocks) {
            at = fill(*block, references, at);
            surround(*block++, slot.around, slot.blocks++);
        }
        slot.end = static_cast<std::uint32_t>(at);
        written_ += slot.blocks;
    }

    /// Fills a block from references[at] on; returns one past the last that it holds.
    std::size_t fill(LeafBlock& block, std::span<const std::uint32_t> references,
                     std::size_t at) const noexcept {
        block.count = 0;
        const auto triangle = [&] { return references[at] & ~format::kSharedReference; };
        while (at < references.size() && block.count < format::kBvhWidth) {
            const std::uint32_t leaf = triangle() / format::kBvhWidth;
            unsigned lanes = 0;
            for (; at < references.size() && triangle() / format::kBvhWidth == leaf; ++at) {
                lanes |= 1U << (triangle() % format::kBvhWidth);
            }
            const format::BvhNode& node = boxes_[leaf / format::kBvhWidth];
            const std::uint32_t box = leaf % format::kBvhWidth;
            const std::uint32_t lane = block.count++;
            block.leaf[lane] = {leaf, static_cast<std::uint8_t>(lanes)};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.boxes.lower[axis][lane] = node.lower[axis][box];
                block.boxes.upper[axis][lane] = node.upper[axis][box];
            }
        }
        return at;
    }

    /// Sets lane `lane` to the box around a block.
    static void surround(const LeafBlock& block, format::BvhNode& around,
                         std::uint32_t lane) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            float lower = block.boxes.lower[axis][0];
            float upper = block.boxes.upper[axis][0];
            for (std::uint32_t i = 1; i < block.count; ++i) {
                lower = std::min(lower, block.boxes.lower[axis][i]);
                upper = std::max(upper, block.boxes.upper[axis][i]);
            }
            around.lower[axis][lane] = lower;
            around.upper[axis][lane] = upper;
        }
    }

    std::array<LeafBlock, kBlocks> block_;
    std::array<Slot, kSlots> slots_;
    const format::BvhNode* boxes_ = nullptr;
    std::uint64_t question_ = 0;
    std::uint64_t written_ = 0;
};

}  // namespace cdprep
