// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "cone_faces.h"

namespace cdprep {

inline constexpr std::uint32_t kOctantKeyBits = 4;  ///< a leading one, and the octant

/// Returns the number of the child that holds the place with barycentric coordinates `l`
/// of the given sum, which become those within the child; ties go to the lowest.
/// is_negative(number) says what its name does.
template <class Number, class IsNegative>
[[nodiscard]] std::uint32_t split_place(std::array<Number, 3>& l, const Number& sum,
                                        const IsNegative& is_negative) noexcept {
    for (std::uint32_t child = 0; child < 3; ++child) {
        if (is_negative(l[child] + l[child] - sum)) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            l[k] = k == child ? l[k] + l[k] - sum : l[k] + l[k];
        }
        return child;
    }
    l = {sum - (l[2] + l[2]), sum - (l[0] + l[0]), sum - (l[1] + l[1])};
    return 3;
}

/// Returns the key of the deepest cone of at most `level` splits that certainly holds
/// the point inside, off all its planes; 0 when that is not even sure of an octant. So
/// a triangle whose corners lie in one cone, by this, touches no other of its level.
[[nodiscard]] inline std::uint32_t inner_cone(const SeenPoint& p, std::uint32_t level) noexcept {
    // x / s is off by 7 u of itself: all differences and sums are of one sign. Times
    // 2^14 that is less than 2^-36.
    constexpr double kMargin = 0x1p-30;
    if (!(p.size > kLeastSeen && p.size < 1 / kLeastSeen)) return 0;
    const double one = 1 / p.size;
    for (std::uint32_t l = level + 1; l-- > 0;) {
        const double steps = static_cast<double>(1U << l) * one;
        std::array<std::int32_t, 3> step;
        double least = 1;
        double most = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double place = std::fabs(p.at[k]) * steps;
            step[k] = static_cast<std::int32_t>(place);
            const double rest = place - step[k];
            least = std::min(least, rest);
            most = std::max(most, rest);
        }
        if (!(least > kMargin && most < 1 - kMargin)) continue;
        // The middle of the cone, in thirds of a step.
        const std::int32_t all = 1 << l;
        const std::int32_t rest = all - step[0] - step[1] - step[2];
        std::array<std::int32_t, 3> middle = {3 * step[0] + rest, 3 * step[1] + rest,
                                              3 * step[2] + rest};
        std::uint32_t key =
            8U | (p.at[0] < 0 ? 1U : 0U) | (p.at[1] < 0 ? 2U : 0U) | (p.at[2] < 0 ? 4U : 0U);
        const auto is_negative = [](std::int32_t number) { return number < 0; };
        for (std::uint32_t i = 0; i < l; ++i) {
            key = key << 2 | split_place(middle, 3 * all, is_negative);
        }
        return key;
    }
    return 0;
}

}  // namespace cdprep
