// SPDX-License-Identifier: MIT
// Planes between places of two models, after B has moved. Included by kernel sources alone, after
// box_overlap.h.
//
// A plane was set across the direction n, fixed to A, when n was m along B's axes. All x of A's
// place had n.x <= p, and all y of B's had m.y >= q. The gap was n.t + k with k = q - p. Let R and
// t be the present pose and n' = R^T n. B's points are at n.t + n'.y, and
//
//     n'.y = m.y + (n' - m).c + (n' - m).(y - c) >= q + (n' - m).c - |n' - m| r
//
// where c is a middle of B's place and r its reach from there.
//
// Rounding. Let v = 2^-24, and s_a and s_b the scales. n and m are at most 1 long, c and r at most
// sqrt 3 s_b. n' is off by 4 v in each component, and n' - m by 5 v. With c and r that is at most
// 2 * 5 v * 3 s_b. The products, sums and the root add at most 8 v of (s_a + s_b + 2 |t|). Together
// they stay below 64 v (s_a + s_b + |t|).
#pragma once

#include <cassert>

#include "kernels.h"

namespace cdprep::kernels {
namespace {

/// A factor of BoxPlacement::slack: for these roundings, and for those when planes were set
/// (front.cpp).
inline constexpr float kPlaneSlack = 3;

/// The body of weak_planes().
template <class R>
std::size_t weak_planes_of(const BoxPlacement& placement, const PlaneRows& planes,
                           std::size_t count, float limit, std::uint16_t* numbers) noexcept {
    // Lanes past the last plane are read too.
    assert(planes.stride % 16 == 0 && count <= planes.stride && planes.stride <= 0x10000);
    assert(limit >= 0 && placement.slack >= 0);
    const float* rotation = placement.rotation;
    const R least(limit + kPlaneSlack * placement.slack);
    std::size_t weak = 0;
    for (std::size_t at = 0; at < count; at += R::kCount) {
        const auto row = [&](std::size_t number) {
            const float* from = planes.first + number * planes.stride + at;
            return R::load_rows(from, from + kLanes);
        };
        R n[3];
        for (std::size_t i = 0; i < 3; ++i) n[i] = row(i);
        R gap = row(9);
        R squared(0.0F);
        for (std::size_t j = 0; j < 3; ++j) {
            gap = fma(n[j], R(placement.shift[j]), gap);
            R turned = n[0] * R(rotation[j]);
            turned = fma(n[1], R(rotation[3 + j]), turned);
            turned = fma(n[2], R(rotation[6 + j]), turned);
            const R by = turned - row(3 + j);
            gap = fma(by, row(6 + j), gap);
            squared = fma(by, by, squared);
        }
        gap = gap - root(squared) * row(10);
        unsigned lanes = ~bits(greater(gap, least)) & ((1U << R::kCount) - 1);
        const std::size_t rest = count - at;
        if (rest < R::kCount) lanes &= (1U << rest) - 1;
        R::store_lanes(lanes, static_cast<unsigned>(at), static_cast<unsigned>(at + kLanes),
                       numbers + weak);
        weak += format::count_set_bits(lanes);
    }
    return weak;
}

}  // namespace
}  // namespace cdprep::kernels
