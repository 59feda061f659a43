// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "cdprep/pairs.h"

namespace cdprep {

/// Room for one pass of sort_pairs().
using SortScratch = std::array<TrianglePair, 4096>;

/// Sorts by (a, b). O(n) where no triangle of A has many, else O(n log n): in passes
/// through the scratch, in parts where it holds fewer. Never allocates.
void sort_pairs(std::span<TrianglePair> pairs, SortScratch& scratch) noexcept;

/// Parts of sorted pairs before they are sorted: no pair of part i is greater than one
/// of part i + 1.
struct PairParts {
    static constexpr std::size_t kParts = 256;
    std::array<std::size_t, kParts + 1> first;  ///< the last one is the number of pairs
};

/// Puts pairs into parts by the highest eight bits in which their numbers differ.
[[nodiscard]] PairParts divide_pairs(std::span<TrianglePair> pairs) noexcept;

}  // namespace cdprep
