// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>

#include "cdprep/format/geometry.h"
#include "cdprep/format/octree.h"
#include "cdprep/model.h"
#include "kernels/kernels.h"

namespace cdprep {

/// A node of the BVH's lowest level.
struct LowNode {
    std::uint32_t number;  ///< of level 0
    std::uint8_t leaves;   ///< its leaves: bit set
};

/// Eight such nodes and the boxes around them.
struct alignas(64) NodeBlock {
    format::BvhNode boxes;
    std::array<LowNode, format::kBvhWidth> node;
    std::uint32_t count;

    [[nodiscard]] unsigned lanes() const noexcept {
        assert(count <= format::kBvhWidth);
        return (1U << count) - 1;
    }
};

/// A part of a cell's list: at most eight blocks, and the boxes around them.
struct NodeList {
    const NodeBlock* block;
    const format::BvhNode* around;
    std::uint32_t blocks;
    std::uint32_t end;  ///< one past its last reference
};

/// The lists of one model's leaf cells, as lowest nodes of its BVH with the boxes around them.
/// Triangles that are consecutive in tree order are neighbours. A walk comes to a cell many times
/// in short succession, so the last kSlots lists are kept.
template <std::size_t kSlots>
class NodeLists {
public:
    /// Begins with another model, or another tree of it.
    void begin(const Model& model) noexcept {
        const format::BvhShape& shape = model.bvh().shape;
        shape_ = &shape;
        boxes_ = shape.levels > 1 ? model.bvh().nodes.data() + shape.first[1] : nullptr;
        ++question_;
    }

    /// Returns as many of the references of cell `node` as one list takes, from `begin` on. The
    /// references are sorted. Valid until the next call.
    [[nodiscard]] NodeList list(std::uint32_t node, std::uint32_t begin,
                                std::span<const std::uint32_t> references) noexcept {
        assert(shape_ != nullptr && begin < references.size());
        Slot& slot = slots_[(node + begin) % kSlots];
        const bool is_same = slot.question == question_ && slot.node == node && slot.begin == begin;
        if (!is_same || written_ - slot.written > kBlocks) {
            // A list does not wrap around the end.
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
    // Most lists have at most two blocks.
    static constexpr std::size_t kBlocks = kSlots == 1 ? kMostBlocks : 2 * kSlots;

    struct Slot {
        std::uint64_t question = 0;
        std::uint64_t written;  ///< its start: valid until kBlocks more were written
        std::uint32_t node;
        std::uint32_t begin;
        std::uint32_t end;
        std::uint32_t blocks;
        format::BvhNode around{};  ///< zeroed as block_
    };

    void fill(Slot& slot, std::span<const std::uint32_t> references) noexcept {
        NodeBlock* block = &block_[slot.written % kBlocks];
        slot.blocks = 0;
        std::size_t at = slot.begin;
        while (at < references.size() && slot.blocks < kMostBlocks) {
            at = fill(*block, references, at);
            surround(*block++, slot.around, slot.blocks++);
        }
        slot.end = static_cast<std::uint32_t>(at);
        written_ += slot.blocks;
    }

    /// Fills a block from references[at] on. Returns one past the last reference that it holds.
    std::size_t fill(NodeBlock& block, std::span<const std::uint32_t> references,
                     std::size_t at) const noexcept {
        block.count = 0;
        constexpr std::uint32_t kOfNode = format::kBvhWidth * format::kBvhWidth;
        const auto triangle = [&] { return references[at] & ~format::kSharedReference; };
        while (at < references.size() && block.count < format::kBvhWidth) {
            const std::uint32_t node = triangle() / kOfNode;
            assert(node < shape_->count[0]);
            while (at < references.size() && triangle() / kOfNode == node) ++at;
            const std::uint32_t lane = block.count++;
            block.node[lane] = {node,
                                static_cast<std::uint8_t>((1U << shape_->used_boxes(0, node)) - 1)};
            put_box(node, block.boxes, lane);
        }
        return at;
    }

    /// Sets lane `lane` to the box around a node, as its parent stores it. A root's box is the
    /// frame.
    void put_box(std::uint32_t node, format::BvhNode& boxes, std::uint32_t lane) const noexcept {
        const std::uint32_t box = node % format::kBvhWidth;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool is_root = boxes_ == nullptr;
            boxes.lower[axis][lane] =
                is_root ? -1.0F : boxes_[node / format::kBvhWidth].lower[axis][box];
            boxes.upper[axis][lane] =
                is_root ? 1.0F : boxes_[node / format::kBvhWidth].upper[axis][box];
        }
    }

    /// Sets lane `lane` to the box around a block.
    static void surround(const NodeBlock& block, format::BvhNode& around,
                         std::uint32_t lane) noexcept {
        assert(block.count > 0 && block.count <= format::kBvhWidth && lane < format::kBvhWidth);
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

    // Lanes past the last of a block hold an earlier block's values, or zeros. Subnormal numbers,
    // which memory may hold, would slow the kernels down.
    std::array<NodeBlock, kBlocks> block_{};
    std::array<Slot, kSlots> slots_;
    const format::BvhShape* shape_ = nullptr;
    const format::BvhNode* boxes_ = nullptr;  ///< of level 1, or null: the root is of level 0
    std::uint64_t question_ = 0;
    std::uint64_t written_ = 0;
};

/// The pairs of low nodes that a query has tested. Some are forgotten, and then tested again.
class MetNodes {
public:
    void begin() noexcept {
        ++question_;
    }
    [[nodiscard]] bool holds(std::uint32_t a, std::uint32_t b) const noexcept {
        const Slot& slot = slots_[slot_of(a, b)];
        return slot.question == question_ && slot.a == a && slot.b == b;
    }
    void add(std::uint32_t a, std::uint32_t b) noexcept {
        assert(question_ > 0);
        slots_[slot_of(a, b)] = {question_, a, b};
    }

private:
    static constexpr std::size_t kSlots = 4096;

    struct Slot {
        std::uint64_t question;
        std::uint32_t a;
        std::uint32_t b;
    };
    static std::size_t slot_of(std::uint32_t a, std::uint32_t b) noexcept {
        return (a * 37 + b) % kSlots;
    }
    std::array<Slot, kSlots> slots_{};
    std::uint64_t question_ = 0;
};

}  // namespace cdprep
