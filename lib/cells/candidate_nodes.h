// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>

#include "kernels/kernels.h"

namespace cdprep {

/// A lowest node of one hierarchy that one of the other may meet. `pairs` are the pairs of their
/// leaves that may meet, with bits as kernels::BoxPairs.
struct CandidateNode {
    kernels::BoxPairs pairs;
    std::uint32_t node;
    std::uint32_t slot;
};

/// A set of lowest nodes, by number. When there is no room for all, it keeps the lower half of the
/// numbers and refuses the others. Numbers below limit() are complete. For the others, call
/// begin(limit()) and add them again.
class CandidateNodes {
public:
    static constexpr std::uint32_t kRoom = 512;
    static constexpr std::uint32_t kNoLimit = 0xffffffffU;

    /// Empties the set. From now on numbers below `from` are refused too.
    void begin(std::uint32_t from) noexcept {
        forget();
        from_ = from;
        limit_ = kNoLimit;
    }
    void add(std::uint32_t node, kernels::BoxPairs pairs) noexcept {
        if (node < from_ || node >= limit_) return;
        std::uint32_t slot = slot_of(node);
        while (index_[slot] != 0) {
            CandidateNode& there = nodes_[index_[slot] - 1U];
            if (there.node == node) {
                there.pairs |= pairs;
                return;
            }
            slot = (slot + 1) % kSlots;
        }
        insert({pairs, node, slot});
        if (count_ == room_) halve();
    }

    [[nodiscard]] std::span<const CandidateNode> nodes() const noexcept {
        return std::span(nodes_).first(count_);
    }
    /// Returns the first number that was refused, or kNoLimit if none was.
    [[nodiscard]] std::uint32_t limit() const noexcept {
        return limit_;
    }

    /// For tests: sets the number of nodes that there is room for, at least 2.
    void set_room(std::uint32_t room) noexcept {
        assert(room >= 2 && room <= kRoom);
        room_ = room;
    }

private:
    static constexpr std::uint32_t kSlots = 2 * kRoom;

    /// Neighbours in the tree, which are likely to occur together, get separate slots.
    static std::uint32_t slot_of(std::uint32_t node) noexcept {
        return (node ^ node >> 10) % kSlots;
    }
    void insert(const CandidateNode& node) noexcept {
        assert(count_ < room_ && index_[node.slot] == 0);
        nodes_[count_++] = node;
        index_[node.slot] = static_cast<std::uint16_t>(count_);
    }
    void forget() noexcept {
        for (const CandidateNode& node : nodes()) index_[node.slot] = 0;
        count_ = 0;
    }
    void halve() noexcept {
        assert(count_ >= 2);
        const auto by_number = [](const CandidateNode& a, const CandidateNode& b) {
            return a.node < b.node;
        };
        const std::uint32_t kept = count_ / 2;
        std::nth_element(nodes_.begin(), nodes_.begin() + kept, nodes_.begin() + count_, by_number);
        limit_ = nodes_[kept].node;
        forget();
        for (std::uint32_t i = 0; i < kept; ++i) {
            std::uint32_t slot = slot_of(nodes_[i].node);
            while (index_[slot] != 0) slot = (slot + 1) % kSlots;
            insert({nodes_[i].pairs, nodes_[i].node, slot});
        }
    }

    std::array<std::uint16_t, kSlots> index_{};  ///< of nodes_, plus one
    std::array<CandidateNode, kRoom> nodes_;
    std::uint32_t count_ = 0;
    std::uint32_t room_ = kRoom;
    std::uint32_t from_ = 0;
    std::uint32_t limit_ = kNoLimit;
};

}  // namespace cdprep
