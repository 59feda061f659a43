// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/bvh_shape.h"
#include "core/carver.h"

namespace cdprep {

/// The boxes of a hierarchy that must be fitted anew: a bit for each leaf and each node. Marks lead
/// from leaves to the root.
class ChangedBoxes {
public:
    ChangedBoxes(Carver& carver, const format::BvhShape& shape) noexcept : shape_(shape) {
        for (std::uint32_t height = 0; height < shape.levels; ++height) {
            words_[height] = carver.take<std::uint64_t>(word_count(height));
        }
    }

    /// Marks the box around a leaf.
    void mark(std::uint32_t leaf) noexcept {
        assert(leaf < shape_.leaf_count);
        words_[0][leaf / kBits] |= std::uint64_t{1} << (leaf % kBits);
    }

    /// Calls leaves(first, last) for the runs of marked leaves. Then calls nodes(level, first,
    /// last) for the runs of marked nodes of each level but the highest, lowest level first.
    /// Removes all marks. Runs of one level are independent, and share no node above the lowest.
    template <class Leaves, class Nodes>
    void sweep(ParallelFor parallel_for, const Leaves& leaves, const Nodes& nodes) noexcept {
        for (std::uint32_t height = 0; height < shape_.levels; ++height) {
            sweep_height(height, parallel_for, [&](std::size_t first, std::size_t last) {
                height == 0 ? leaves(first, last) : nodes(height - 1, first, last);
            });
        }
    }

private:
    static constexpr std::uint32_t kBits = 64;
    /// A task clears this many words, which lead to one word of the level above.
    static constexpr std::size_t kWordsPerTask = format::kBvhWidth;

    [[nodiscard]] std::size_t word_count(std::uint32_t height) const noexcept {
        const std::size_t places = height == 0 ? shape_.leaf_count : shape_.count[height - 1];
        return (places + kBits - 1) / kBits;
    }

    template <class Visit>
    void sweep_height(std::uint32_t height, ParallelFor parallel_for, const Visit& visit) noexcept {
        std::uint64_t* const words = words_[height];
        for_chunks(word_count(height), kWordsPerTask, parallel_for,
                   [&](std::size_t first, std::size_t last) {
                       std::uint64_t above = 0;
                       for (std::size_t word = first; word < last; ++word) {
                           if (words[word] == 0) continue;
                           above |= parents(words[word]) << (8 * (word - first));
                           visit_runs(words[word], word * kBits, visit);
                           words[word] = 0;
                       }
                       if (height + 1 < shape_.levels) words_[height + 1][first / 8] |= above;
                   });
    }

    /// Returns a bit for each of the eight nodes that have a marked child among 64.
    static std::uint64_t parents(std::uint64_t children) noexcept {
        std::uint64_t bits = 0;
        for (std::uint32_t node = 0; node < 8; ++node) {
            if (((children >> (8 * node)) & 0xff) != 0) bits |= std::uint64_t{1} << node;
        }
        return bits;
    }

    template <class Visit>
    static void visit_runs(std::uint64_t bits, std::size_t base, const Visit& visit) {
        while (bits != 0) {
            const auto first = static_cast<std::uint32_t>(std::countr_zero(bits));
            const auto size = static_cast<std::uint32_t>(std::countr_one(bits >> first));
            visit(base + first, base + first + size);
            if (first + size == kBits) return;
            bits &= ~std::uint64_t{0} << (first + size);
        }
    }

    format::BvhShape shape_;
    std::array<std::uint64_t*, format::kMaxBvhLevels> words_{};
};

}  // namespace cdprep
