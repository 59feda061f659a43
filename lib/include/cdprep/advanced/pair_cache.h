// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/pose.h"

namespace cdprep {

/// Results of earlier queries on one pair of models, owned by the caller. The next query about the
/// pair starts there. A cache changes speed, never answers.
///
/// It holds the last nearest or touching pair of triangles. It also holds a placement at which the
/// surfaces were proven to be a gap apart. Until the models have moved that far, they do not touch.
///
/// Use one cache for each pair of models and thread, for any queries. A cache of another pair only
/// costs time, and so does one of a build::RuntimeModel before its last refit(). Make a new cache
/// if anything other than refit() changed a model's memory in place. The members belong to the
/// library; all zero is a new cache.
struct PairCache {
    std::uint32_t holds = 0;                   ///< bits: 1 pair, 2 placement, 4 the pair touched
    std::uint32_t triangle_a = 0;              ///< of the pair, tree order
    std::uint32_t triangle_b = 0;              ///< tree order
    std::uint32_t questions = 0;               ///< queries since the placement was stored
    std::uint32_t failures = 0;                ///< failed proofs of a gap in a row
    std::uint32_t wait = 0;                    ///< queries before the next proof
    std::array<std::uint64_t, 2> models = {};  ///< content hashes of A and B at the placement
    double gap = 0;       ///< model units: proven lower bound of the distance at the placement
    double step = 0;      ///< model units: the way that B moves per query
    double proof = 0;     ///< model units: the gap of the last attempted proof
    Pose a_from_b;        ///< the placement
    Double3 middle = {};  ///< of a box around B, B's coordinates
    Double3 half = {};    ///< its half extents
};

}  // namespace cdprep
