// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>

#include "cells/cone_faces.h"

namespace cdprep {

inline constexpr std::uint32_t kOctantKeyBits = 4;  ///< a leading one, and the octant

/// Returns the key, below an octant's, of the cone that holds the places between whole steps that
/// begin at `step`. There are 2^level steps along each edge of the octant's face.
///
/// The first binary digits of a place give its children. The child of a corner holds places whose
/// coordinate there is past the middle, and doubles the rest of all coordinates. In the middle
/// child, coordinates run from the middles of the edges inwards.
[[nodiscard]] inline std::uint32_t cone_below(std::uint32_t key, std::uint32_t level,
                                              std::array<std::uint32_t, 3> step) noexcept {
    for (std::uint32_t bit = level; bit-- > 0;) {
        const std::uint32_t rest = (1U << bit) - 1;
        // At most one of them is set.
        const std::uint32_t past = step[0] >> bit | step[1] >> bit << 1 | step[2] >> bit << 2;
        assert(past < 8 && (past & (past - 1)) == 0);
        if (past != 0) {
            key = key << 2 | past >> 1;
            step = {step[0] & rest, step[1] & rest, step[2] & rest};
        } else {
            key = key << 2 | 3;
            step = {~step[2] & rest, ~step[0] & rest, ~step[1] & rest};
        }
    }
    return key;
}

/// Returns the key of the deepest cone, of at most `level` splits, that certainly holds the point
/// inside, off all its planes. Returns 0 when not even the octant is certain. So a triangle whose
/// corners lie in one such cone touches no other cone of its level.
[[nodiscard]] inline std::uint32_t inner_cone(const SeenPoint& p, std::uint32_t level) noexcept {
    assert(level <= format::kMaxTetraLevel);
    // x / s is off by 7 u of itself, because all differences and sums are of one sign. Times 2^14
    // that is less than 2^-36.
    constexpr double kMargin = 0x1p-30;
    if (!(p.size > kLeastSeen && p.size < 1 / kLeastSeen)) return 0;
    const double one = 1 / p.size;
    const std::uint32_t octant =
        8U | (p.at[0] < 0 ? 1U : 0U) | (p.at[1] < 0 ? 2U : 0U) | (p.at[2] < 0 ? 4U : 0U);
    for (std::uint32_t l = level + 1; l-- > 0;) {
        const double steps = static_cast<double>(1U << l) * one;
        std::array<std::uint32_t, 3> step;
        double least = 1;
        double most = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double place = std::fabs(p.at[k]) * steps;
            const auto whole = static_cast<std::int32_t>(place);
            const double rest = place - whole;
            step[k] = static_cast<std::uint32_t>(whole);
            least = std::min(least, rest);
            most = std::max(most, rest);
        }
        if (least > kMargin && most < 1 - kMargin) return cone_below(octant, l, step);
    }
    return 0;
}

}  // namespace cdprep
