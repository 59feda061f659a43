// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/advanced/pair_cache.h"

namespace cdprep {

/// The largest number of node pairs that a PairFront keeps.
inline constexpr std::uint32_t kFrontRoom = 512;

/// Separating planes between node pairs of the BVHs over two models' pieces, owned by the caller.
/// They come from earlier queries, and the node pairs together cover both models. If models move
/// little from query to query, few planes have to be moved. If there is no room for more pairs, the
/// search continues below those that are kept. If the array overflows at the start or the models
/// jump, the front stays unused for a number of queries.
///
/// The members belong to the library; all zero is a new front.
struct PairFront {
    std::array<std::uint64_t, 2> models = {};  ///< content hashes of A and B
    std::uint32_t count = 0;                   ///< pairs; 0: the front is empty
    std::uint32_t begun_with = 0;  ///< the number of pairs after the last restart; 0: none yet
    std::uint32_t failures = 0;    ///< losses of the front in a row
    std::uint32_t wait = 0;        ///< queries before the next restart
    std::array<std::uint64_t, kFrontRoom> pair = {};  ///< node pairs, as walks pack them
    /// Rows 0 to 2: a direction from A to B, along A's axes. Rows 3 to 5: the same along B's axes
    /// when the plane was set. Rows 6 to 8: a middle of B's node. Row 9: the gap along the
    /// direction, without B's shift. Row 10: the reach of B's node from its middle. Row 11: the
    /// reach of A's node along the direction. Pair units.
    std::array<std::array<float, kFrontRoom>, 12> row = {};
};

/// Both caches of one pair of models, for queries through Structure::pieces: Pair::cache and
/// Pair::front. They change speed, never answers. The first distance query sets the planes and
/// takes about three times as long; the next ones move a few. About 28 KiB.
struct PieceCache {
    PairCache pair;
    PairFront front;
};

}  // namespace cdprep
