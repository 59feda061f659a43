// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "cdprep/format/geometry.h"
#include "exact/wide_integer.h"

namespace cdprep {

/// A vector of integers: doubles as multiples of the lowest bit that occurs in a query, or products
/// of such integers.
template <std::size_t kLimbs>
using WideVector = std::array<WideInteger<kLimbs>, 3>;
/// A point, a difference of two points, or a difference of two differences.
using WidePlace = WideVector<kWideCoordinate>;

template <std::size_t kLimbs>
WideVector<kLimbs> operator-(const WideVector<kLimbs>& a, const WideVector<kLimbs>& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <std::size_t kLimbs>
WideVector<kLimbs> operator+(const WideVector<kLimbs>& a, const WideVector<kLimbs>& b) noexcept {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <std::size_t kLimbs, std::size_t kOther>
WideVector<kLimbs + kOther> operator*(const WideInteger<kLimbs>& s,
                                      const WideVector<kOther>& a) noexcept {
    return {s * a[0], s * a[1], s * a[2]};
}

template <std::size_t kLimbs, std::size_t kOther>
WideInteger<kLimbs + kOther> dot(const WideVector<kLimbs>& a,
                                 const WideVector<kOther>& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <std::size_t kLimbs, std::size_t kOther>
WideVector<kLimbs + kOther> cross(const WideVector<kLimbs>& a,
                                  const WideVector<kOther>& b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns the lowest bit of all the points' coordinates.
inline int lowest_bit_of(std::span<const format::Double3> points) noexcept {
    int lowest = lowest_bit(0);
    for (const format::Double3& p : points) {
        lowest = std::min({lowest, lowest_bit(p.x), lowest_bit(p.y), lowest_bit(p.z)});
    }
    return lowest;
}

/// Returns p / 2^lowest. Requires that `lowest` is at most the point's lowest bit.
inline WidePlace wide_place(const format::Double3& p, int lowest) noexcept {
    using Length = WideInteger<kWideCoordinate>;
    return {Length::from_double(p.x, lowest), Length::from_double(p.y, lowest),
            Length::from_double(p.z, lowest)};
}

}  // namespace cdprep
