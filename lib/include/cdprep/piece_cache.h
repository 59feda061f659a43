// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/pair_cache.h"
#include "cdprep/pair_front.h"

namespace cdprep {

/// What earlier questions about one pair of models found through their pieces, owned by the
/// caller: as PairCache, which it holds and which serves questions through the hierarchy of
/// boxes likewise. The answers are the same.
///
/// Beside, for distances, planes that part the pieces: the first such question sets them, and takes
/// some three times as long, the next ones move a few. Questions whether anything touches start
/// from `pair` alone. Some 28 KiB. The members belong to the library; all zero is a new cache.
struct PieceCache {
    PairCache pair;
    PairFront front;
};

}  // namespace cdprep
