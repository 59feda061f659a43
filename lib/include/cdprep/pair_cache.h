// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace cdprep {

/// What the last question about one pair of models found, owned by the caller:
/// the next question about the same pair starts there. Poses that change little
/// from question to question are then answered faster; the answers are the same.
///
/// One a pair of models; a cache of another pair only costs time. Threads need
/// one each.
struct PairCache {
    static constexpr std::uint32_t kNone = 0xffffffff;
    std::uint32_t triangle_a = kNone;  ///< tree order
    std::uint32_t triangle_b = kNone;  ///< tree order
};

}  // namespace cdprep
