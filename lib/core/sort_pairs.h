// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// The scratch memory for one pass of sort_pairs().
using SortScratch = std::array<TrianglePair, 4096>;

/// Sorts by (a, b). Takes O(n) if no triangle of A has many pairs, otherwise O(n log n). Sorts in
/// passes through the scratch, and in parts if the scratch is smaller. Never allocates.
CDPREP_API void sort_pairs(std::span<TrianglePair> pairs, SortScratch& scratch) noexcept;

/// The parts into which pairs are divided before they are sorted. No pair of part i is greater than
/// a pair of part i + 1.
struct PairParts {
    static constexpr std::size_t kParts = 256;
    std::array<std::size_t, kParts + 1> first;  ///< the last one is the number of pairs
};

/// Divides pairs into parts by the highest eight bits in which their numbers differ.
[[nodiscard]] PairParts divide_pairs(std::span<TrianglePair> pairs) noexcept;

}  // namespace cdprep
