// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "cdprep/overlapping_triangles.h"

namespace cdprep {

/// Room for one pass of sort_pairs().
using SortScratch = std::array<TrianglePair, 4096>;

/// Sorts by (a, b). O(n) for as many pairs as the scratch holds where no triangle of A
/// has many, else O(n log n). Never allocates.
void sort_pairs(std::span<TrianglePair> pairs, SortScratch& scratch) noexcept;

}  // namespace cdprep
