// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/pose.h"

namespace cdprep {

/// Results of earlier queries on one pair of models, owned by the caller. The next query about the
/// pair starts from them. A cache changes speed, never answers. Only a distance with permitted
/// errors may become another one within these errors.
///
/// A cache holds the last nearest or touching pair of triangles. It also holds a placement and the
/// gap there: a proven lower bound of the distance of the surfaces. Until the models have moved by
/// the gap relative to each other, they do not touch.
///
/// Use one cache for each pair of models and thread, for any queries. A cache from another pair, or
/// from before a LiveModel changed, is safe but may save no time. Make a new cache if anything but
/// a LiveModel changed a model's memory in place. The members belong to the library; a new cache is
/// all zero.
struct PairCache {
    std::uint32_t holds = 0;                   ///< bits: 1 pair, 2 placement, 4 the pair touched
    std::uint32_t triangle_a = 0;              ///< of the pair, tree order
    std::uint32_t triangle_b = 0;              ///< tree order
    std::uint32_t questions = 0;               ///< queries since the placement was stored
    std::uint32_t failures = 0;                ///< consecutive failed proofs of a gap; stops at 4
    std::uint32_t wait = 0;                    ///< queries to wait before the next proof attempt
    std::array<std::uint64_t, 2> models = {};  ///< content hashes of A and B at the placement
    double gap = 0;       ///< model units: proven lower bound of the distance at the placement
    double step = 0;      ///< model units: mean motion of B relative to A per query
    double proof = 0;     ///< model units: the gap that the last attempt proved, or 0 if it failed
    Pose a_from_b;        ///< the placement
    Double3 middle = {};  ///< the middle of a box around B, in B's coordinates
    Double3 half = {};    ///< the half extents of this box
};

}  // namespace cdprep
