// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "accuracy/ladder.h"

namespace cdprep::study {

/// The same exact questions asked cold (nothing of the models in the processor's caches), warm,
/// and with a PairCache, along walks on which B moves by 1/1000 of the diagonal and turns by
/// 0.2 degrees a frame. Only time differs: every answer promises to be exact.
[[nodiscard]] Ladder climb_coherence(const Climb& climb, std::uint64_t last_cache, Broken& broken);

}  // namespace cdprep::study
