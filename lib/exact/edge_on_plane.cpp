// SPDX-License-Identifier: MIT
#include "exact/edge_on_plane.h"

#include <algorithm>

#include "exact/leading_bits.h"
#include "exact/wide_integer.h"

// Let s0 and s1 be the signed volumes of the ends p0 and p1; their signs are opposite. The point is
// (p0 |s1| + p1 |s0|) / (|s0| + |s1|). Numerator and denominator are integers when the coordinates
// are. Their first 129 bits or more are divided in twice the precision of double. The error before
// the final rounding is below 2^-98 of the quotient.

namespace cdprep {
namespace {

using Length = WideInteger<kWideCoordinate>;
using Volume = WideInteger<3 * kWideCoordinate>;
using Place = std::array<Length, 3>;

Place operator-(const Place& a, const Place& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Volume volume(const Place& u, const Place& v, const Place& w) noexcept {
    return (v[1] * w[2] - v[2] * w[1]) * u[0] + (v[2] * w[0] - v[0] * w[2]) * u[1] +
           (v[0] * w[1] - v[1] * w[0]) * u[2];
}

template <std::size_t kLimbs>
WideInteger<kLimbs> size_of(const WideInteger<kLimbs>& a) noexcept {
    return a.sign() < 0 ? -a : a;
}

int lowest_of(const Double3& p) noexcept {
    return std::min({lowest_bit(p.x), lowest_bit(p.y), lowest_bit(p.z)});
}

Place in_units(const Double3& p, int lowest) noexcept {
    return {Length::from_double(p.x, lowest), Length::from_double(p.y, lowest),
            Length::from_double(p.z, lowest)};
}

}  // namespace

Double3 edge_on_plane(const Double3& from, const Double3& to, const Corners& plane) noexcept {
    const int lowest = std::min({lowest_of(from), lowest_of(to), lowest_of(plane[0]),
                                 lowest_of(plane[1]), lowest_of(plane[2])});
    const Place p0 = in_units(from, lowest), p1 = in_units(to, lowest);
    const Place origin = in_units(plane[0], lowest);
    const Place u = in_units(plane[1], lowest) - origin, v = in_units(plane[2], lowest) - origin;
    const Volume weight0 = size_of(volume(p1 - origin, u, v));
    const Volume weight1 = size_of(volume(p0 - origin, u, v));
    const LeadingBits all = leading_bits(weight0 + weight1);
    const auto coordinate = [&](std::size_t axis) {
        return quotient(leading_bits(weight0 * p0[axis] + weight1 * p1[axis]), all, lowest);
    };
    return {coordinate(0), coordinate(1), coordinate(2)};
}

}  // namespace cdprep
