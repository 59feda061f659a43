// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/convex_distance.h"
#include "cdprep/pair_cache.h"

namespace cdprep {

/// What earlier questions about one pair of models found through their pieces, owned by the
/// caller: as PairCache, which it holds and which serves questions through the hierarchy of
/// boxes likewise. The answers are the same with any content.
///
/// Beside, where the last contact was among the pieces, and how the hulls around both models
/// were proved to be apart. The members belong to the library; all zero is a new cache.
struct PieceCache {
    PairCache pair;
    ConvexCache hulls;                ///< around all of either model
    std::uint32_t leaf_a = 0;         ///< of the last contact, in piece_leaves
    std::uint32_t leaf_b = 0;         ///< likewise
    std::uint32_t hull_wait = 0;      ///< questions to let pass before hulls are asked again
    std::uint32_t hull_failures = 0;  ///< times in a row that they proved nothing
};

}  // namespace cdprep
