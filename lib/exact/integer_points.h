// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cdprep/format/portable.h"
#include "exact/expansion.h"

namespace cdprep {

/// A point with integer coordinates. Differences are at most 2^62 + 2^9 in magnitude per
/// coordinate, so all signs below are exact in machine integers.
struct Integer3 {
    std::int64_t x, y, z;
};
struct Integer2 {
    std::int64_t x, y;
};

/// The differences along one axis as integers, if they fit.
template <std::size_t N>
struct ScaledAxis {
    std::array<std::int64_t, N> at;
    bool fits;
};

/// Returns the exact x[i] - from, times a power of two. The power puts the largest between
/// 2^(bits - 1) and 2^bits (plus 2^(bits - 53)). The numbers fit unless they spread over more than
/// `bits` bits, which is rare for floats, grids and corners near each other. `bits` is at most 62.
/// Each axis may have its own power of two: no sign below depends on it.
template <std::size_t N>
[[nodiscard]] ScaledAxis<N> scaled_axis(const std::array<double, N>& x, double from,
                                        int bits) noexcept;

/// The counterparts of the functions for doubles in predicates.h.
[[nodiscard]] int orient2d(const Integer2& a, const Integer2& b, const Integer2& c) noexcept;
[[nodiscard]] int orient3d(const Integer3& a, const Integer3& b, const Integer3& c,
                           const Integer3& d) noexcept;
[[nodiscard]] std::array<int, 3> plane_signs(const std::array<Integer3, 3>& plane,
                                             const std::array<Integer3, 3>& points) noexcept;

// --- Implementation ------------------------------------------------------------------

/// Adds value * scale to `sum`. Returns false when the product is not an integer. The product is
/// below 2^63. Dividing it again must reproduce the value, so underflow is detected too.
inline bool add_scaled(double value, double scale, double unscale, std::int64_t& sum) noexcept {
    const auto integer = static_cast<std::int64_t>(value * scale);
    sum += integer;
    return static_cast<double>(integer) * unscale == value;
}

inline double power_of_two(int exponent) noexcept {
    assert(exponent > -1023 && exponent < 1024);
    return format::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

template <std::size_t N>
ScaledAxis<N> scaled_axis(const std::array<double, N>& x, double from, int bits) noexcept {
    assert(bits > 0 && bits <= 62);
    constexpr double kLeastToScale = 0x1p-900;  // below this, the scale is not a double
    constexpr double kLift = 0x1p600;
    std::array<Exact2, N> difference;
    double most = 0;
    bool rounded = false;
    for (std::size_t i = 0; i < N; ++i) {
        difference[i] = two_sum(x[i], -from);
        most = std::max(most, std::fabs(difference[i].value));
        rounded |= difference[i].tail != 0;
    }
    ScaledAxis<N> result{};
    result.fits = most == 0;
    if (most == 0 || most > std::numeric_limits<double>::max()) return result;
    if (most < kLeastToScale) {
        for (Exact2& d : difference) d = {d.value * kLift, d.tail * kLift};
        most *= kLift;
    }
    const int shift =
        bits - 1 - (static_cast<int>(format::bit_cast<std::uint64_t>(most) >> 52) - 1023);
    const double scale = power_of_two(shift);
    const double unscale = power_of_two(-shift);
    result.fits = true;
    for (std::size_t i = 0; i < N; ++i) {
        result.fits &= add_scaled(difference[i].value, scale, unscale, result.at[i]);
    }
    for (std::size_t i = 0; i < N && rounded; ++i) {
        result.fits &= add_scaled(difference[i].tail, scale, unscale, result.at[i]);
    }
    return result;
}

}  // namespace cdprep
