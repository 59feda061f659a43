// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/advanced/pair_cache.h"

namespace cdprep {

/// The largest number of node pairs that a PairFront keeps.
inline constexpr std::uint32_t kFrontRoom = 512;

/// Separating planes between node pairs of the BVHs over two models' pieces, owned by the caller.
/// The planes come from earlier queries, and the node pairs together cover both models. If the
/// models move little from query to query, few planes have to be updated. If there is no room for
/// more pairs, the search descends from the pairs that are kept. The front is emptied if the room
/// is too small when it is started, or if the models jump. It then stays unused for `wait` queries:
/// none after the first failure, then more after each, up to 63.
///
/// The members belong to the library; a new front is all zero.
struct PairFront {
    std::array<std::uint64_t, 2> models = {};  ///< content hashes of A and B
    std::uint32_t count = 0;                   ///< pairs; 0: the front is empty
    std::uint32_t begun_with = 0;  ///< pairs after the first full query since the restart, or 0
    std::uint32_t failures = 0;    ///< consecutive times that the front was emptied; stops at 6
    std::uint32_t wait = 0;        ///< queries before the next restart
    std::array<std::uint64_t, kFrontRoom> pair = {};  ///< node pairs, each packed in one word
    /// The planes, in pair units: one column for each node pair. Rows 0 to 2: the direction across
    /// the plane, from A to B, in A's axes. Rows 3 to 5: this direction in B's axes when the plane
    /// was set. Rows 6 to 8: the middle of B's node. Row 9: the gap along the direction, without
    /// the part that is due to B's translation. Row 10: the radius of B's node around this middle.
    /// Row 11: how far A's node extends along the direction.
    std::array<std::array<float, kFrontRoom>, 12> row = {};
};

/// Both caches of one pair of models, for queries through Structure::pieces: Pair::cache and
/// Pair::front. They change speed, never answers. Only a distance with permitted errors may become
/// another one within these errors. The first distance query fills the front with planes. This
/// query takes about three times as long as one without caches. Later queries update a few planes.
/// A PieceCache takes about 28 KiB.
struct PieceCache {
    PairCache pair;
    PairFront front;
};

}  // namespace cdprep
