// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/pose.h"

namespace cdprep {

/// Results of earlier queries on one pair of models, owned by the caller: the next question about
/// the pair starts there. A cache changes speed, never answers.
///
/// It holds the last nearest or touching pair of triangles, and a place where the surfaces were
/// proved to be some gap apart: until the models have moved that far, they do not touch.
///
/// Use one for each pair of models, for any questions; a cache of another pair only costs time,
/// and so does one of a build::RuntimeModel before its last refit(). Threads need one each. A cache
/// must be made anew when the memory of a model was changed in place by other means.
/// The members belong to the library; all zero is a new cache.
struct PairCache {
    std::uint32_t holds = 0;                   ///< bit set: 1 a pair, 2 a place, 4 the pair touched
    std::uint32_t triangle_a = 0;              ///< of the pair, tree order
    std::uint32_t triangle_b = 0;              ///< tree order
    std::uint32_t questions = 0;               ///< asked since the place was noted
    std::uint32_t failures = 0;                ///< proofs of a gap that failed in a row
    std::uint32_t wait = 0;                    ///< questions to let pass before the next proof
    std::array<std::uint64_t, 2> models = {};  ///< content hashes of A and B, of the place
    double gap = 0;       ///< model units; at the place the surfaces were so far apart, at least
    double step = 0;      ///< model units: how far B moves from question to question
    double proof = 0;     ///< model units: the gap that was last tried to be proved
    Pose a_from_b;        ///< the place
    Double3 middle = {};  ///< of a box around B, B's coordinates
    Double3 half = {};    ///< its half extents
};

}  // namespace cdprep
