// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/carver.h"

namespace cdprep {

/// Nodes of a tree with a mark: a bit each, by their numbers.
class MarkedNodes {
public:
    MarkedNodes(Carver& carver, std::size_t nodes) noexcept
        : count_((nodes + kBits - 1) / kBits), words_(carver.take<std::uint64_t>(count_)) {}

    void set(std::uint32_t node) noexcept {
        words_[node / kBits] |= std::uint64_t{1} << (node % kBits);
    }
    /// Removes the marks of nodes first, ..., last - 1.
    void clear(std::uint32_t first, std::uint32_t last) noexcept {
        for (std::uint32_t node = first; node < last; ++node) {
            words_[node / kBits] &= ~(std::uint64_t{1} << (node % kBits));
        }
    }
    /// Removes all marks. Calls visit(node) for each, in rising order. It may clear those of later
    /// nodes.
    template <class Visit>
    void take_all(const Visit& visit) noexcept {
        for (std::size_t word = 0; word < count_; ++word) {
            while (words_[word] != 0) {
                const auto bit = static_cast<std::uint32_t>(std::countr_zero(words_[word]));
                words_[word] &= words_[word] - 1;
                visit(static_cast<std::uint32_t>(word * kBits) + bit);
            }
        }
    }

private:
    static constexpr std::uint32_t kBits = 64;

    std::size_t count_;
    std::uint64_t* words_;
};

}  // namespace cdprep
