// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/advanced/pair_cache.h"

namespace cdprep {

/// Most pairs of places that a PairFront keeps.
inline constexpr std::uint32_t kFrontRoom = 512;

/// Separating planes between node pairs of two models' hierarchies over pieces, from earlier
/// questions about them, owned by the caller. Together the node pairs cover both models. Where
/// models move little from question to question, few planes have to be moved. Where there is no
/// room for more pairs, the search goes on below those that are kept. If the array overflows at the
/// start or the models jump, the front stays unused for a number of queries.
///
/// The members belong to the library; all zero is a new one.
struct PairFront {
    std::array<std::uint64_t, 2> models = {};  ///< content hashes of A and B
    std::uint32_t count = 0;                   ///< pairs; 0: it holds nothing
    std::uint32_t begun_with = 0;  ///< pairs there were once it had been begun anew; 0: not yet
    std::uint32_t failures = 0;    ///< times in a row that it was lost
    std::uint32_t wait = 0;        ///< questions to let pass before it is begun anew
    std::array<std::uint64_t, kFrontRoom> pair = {};  ///< of places, as walks pack them
    /// By row: 0 to 2 a direction from A to B, A's axes; 3 to 5 the same along B's axes when the
    /// plane was set; 6 to 8 a middle of B's place; 9 the gap along the direction, but for B's
    /// shift; 10 how far B's place reaches from its middle; 11 how far A's place reaches along the
    /// direction. Pair units.
    std::array<std::array<float, kFrontRoom>, 12> row = {};
};

/// Both caches of one pair of models, for questions through Structure::pieces: Pair::cache and
/// Pair::front. They change speed, never answers. The first distance sets the planes and takes some
/// three times as long; the next ones move a few. Some 28 KiB.
struct PieceCache {
    PairCache pair;
    PairFront front;
};

}  // namespace cdprep
