// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/pair_cache.h"
#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

/// Bits of PairCache::holds.
enum Held : std::uint32_t { held_pair = 1, held_place = 2, held_touch = 4 };

/// Returns a lower bound of the distance of the surfaces in `placement`, in model units: the proved
/// gap minus the motion since. 0 or less if the cache proves nothing. Counts the query.
[[nodiscard]] double proven_gap(PairCache& cache, const Model& a, const Model& b,
                                const Placement& placement) noexcept;

/// Returns the gap minus the motion since then, in model units. Whatever was at least the gap away
/// is farther than this in `placement`. Minus infinity if the cache holds no placement of these
/// models.
[[nodiscard]] double gap_left(const PairCache& cache, const Model& a, const Model& b,
                              const Placement& placement) noexcept;

/// Stores the placement and a proved lower bound `gap` of the distance there, or 0 if none is
/// known. Requires that neither model is empty.
void remember_gap(PairCache& cache, const Model& a, const Model& b, const Placement& placement,
                  double gap) noexcept;

}  // namespace cdprep
