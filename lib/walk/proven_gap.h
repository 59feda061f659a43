// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/pair_cache.h"
#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

/// Bits of PairCache::holds.
enum Held : std::uint32_t { held_pair = 1, held_place = 2, held_touch = 4 };

/// Returns a lower bound of how far the surfaces are apart in `placement`, model
/// units: what was proved, less how far the models have moved since. 0 or less where
/// the cache proves nothing. Counts the question.
[[nodiscard]] double proven_gap(PairCache& cache, const Model& a, const Model& b,
                                const Placement& placement) noexcept;

/// Takes note of the place, and that the surfaces are at least `gap` apart there, or 0
/// when that is not known. Neither model is empty.
void remember_gap(PairCache& cache, const Model& a, const Model& b, const Placement& placement,
                  double gap) noexcept;

}  // namespace cdprep
