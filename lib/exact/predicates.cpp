// SPDX-License-Identifier: MIT
#include "exact/predicates.h"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>

#include "exact/expansion.h"
#include "exact/integer_points.h"
#include "exact/wide_integer.h"

// There are five stages. Each is exact when it answers.
//
// 1. The filter of predicates.h, while no difference is too small or too large for it. The filter
//    of orient2d is Shewchuk's, (3 + 16u) u (|left| + |right|).
// 2. Equal points: neighbours in a mesh share corners.
// 3. Machine integers, if a power of two for each axis makes all differences along it 62-bit
//    integers. Floats, grids, and corners near each other nearly always fit.
// 4. Expansions of the exact differences, with two components each. Floats and grids nearly always
//    give exact differences with one component; dropping zero components then reduces the work. A
//    component of size 2^e is a multiple of 2^(e - 52). If all are 0 or between 2^-250 and 2^300,
//    a product of three is a multiple of 2^-906 and below 2^903: nothing is lost. Otherwise a power
//    of two brings the largest coordinate below 2^300. All are multiples of 2^lowest, so products
//    stay exact when 3 lowest >= -1074.
// 5. Integers wide enough for any doubles, when the exponents spread further.

static_assert(FLT_EVAL_METHOD == 0, "double must be evaluated in double");

namespace cdprep {
namespace {

constexpr double kFilter2d = 4.0 * 0x1p-53 * 1.0625;  ///< 4.25 u, above 3 u + 16 u^2
constexpr double kLeastForFilter2d = 1e-290;   ///< products that underflow would go unnoticed
constexpr double kLargestForFilter2d = 1e150;  ///< products stay finite
constexpr int kIntegerBits = 62;               ///< of a difference, in machine integers

int sign_of(double value) {
    return (value > 0) - (value < 0);
}

/// The exponents of the highest and lowest bits over all coordinates.
struct Spread {
    int highest = -2000;
    int lowest = 2000;
};

void widen(Spread& spread, double value) {
    if (value == 0) return;
    int exponent = 0;
    const double fraction = std::frexp(std::fabs(value), &exponent);
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    const int zeros = std::countr_zero(mantissa);
    spread.highest = std::max(spread.highest, exponent);
    spread.lowest = std::min(spread.lowest, exponent - 53 + zeros);
}

/// The power of two that brings all coordinates below 2^300. Not possible when their lowest bit
/// would then be too low for products of `factors` factors.
struct Scale {
    bool possible;
    int exponent;
};

Scale find_scale(const Spread& spread, int factors) {
    constexpr int kHighest = 300;
    constexpr int kLowestBit = -1074;
    const int exponent = kHighest - spread.highest;
    return {(spread.lowest + exponent) * factors >= kLowestBit, exponent};
}

bool safe_to_multiply(double component) {
    const double size = std::fabs(component);
    return size == 0 || (size >= 0x1p-250 && size <= 0x1p300);
}

template <class... Differences>
bool all_safe(const Differences&... differences) {
    const auto safe = [](const Expansion<2>& e) {
        return (e.size < 1 || safe_to_multiply(e.component[0])) &&
               (e.size < 2 || safe_to_multiply(e.component[1]));
    };
    return (safe(differences) && ...);
}

WideInteger<kWideCoordinate> wide_difference(double a, double b) {
    using Wide = WideInteger<kWideCoordinate>;
    return Wide::from_double(a) - Wide::from_double(b);
}

/// The rows of the determinant.
struct Expanded2 {
    Expansion<2> ax, ay, bx, by;

    [[nodiscard]] bool safe() const {
        return all_safe(ax, ay, bx, by);
    }
    [[nodiscard]] int sign() const {
        return sum(product(ax, by), product(negated(ay), bx)).sign();
    }
};

Expanded2 expanded(const Double2& a, const Double2& b, const Double2& c) {
    return {difference(a.x, c.x), difference(a.y, c.y), difference(b.x, c.x), difference(b.y, c.y)};
}

Double2 scaled_by(int exponent, const Double2& p) {
    return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent)};
}

int orient2d_wide(const Double2& a, const Double2& b, const Double2& c) {
    return (wide_difference(a.x, c.x) * wide_difference(b.y, c.y) -
            wide_difference(a.y, c.y) * wide_difference(b.x, c.x))
        .sign();
}

int orient2d_beyond_filter(const Double2& a, const Double2& b, const Double2& c) {
    const auto x = scaled_axis<2>({a.x, b.x}, c.x, kIntegerBits);
    const auto y = scaled_axis<2>({a.y, b.y}, c.y, kIntegerBits);
    if (x.fits && y.fits) return orient2d(Integer2{x.at[0], y.at[0]}, {x.at[1], y.at[1]}, {0, 0});
    const Expanded2 rows = expanded(a, b, c);
    if (rows.safe()) return rows.sign();
    Spread spread;
    for (const double value : {a.x, a.y, b.x, b.y, c.x, c.y}) widen(spread, value);
    const Scale scale = find_scale(spread, 2);
    if (!scale.possible) return orient2d_wide(a, b, c);
    const int e = scale.exponent;
    return expanded(scaled_by(e, a), scaled_by(e, b), scaled_by(e, c)).sign();
}

/// The rows of the determinant.
struct Expanded3 {
    Expansion<2> ax, ay, az, bx, by, bz, cx, cy, cz;

    [[nodiscard]] bool safe() const {
        return all_safe(ax, ay, az, bx, by, bz, cx, cy, cz);
    }
    [[nodiscard]] int sign() const {
        const auto minor_a = sum(product(by, cz), product(negated(bz), cy));
        const auto minor_b = sum(product(cy, az), product(negated(cz), ay));
        const auto minor_c = sum(product(ay, bz), product(negated(az), by));
        return sum(sum(product(minor_a, ax), product(minor_b, bx)), product(minor_c, cx)).sign();
    }
};

Expanded3 expanded(const Double3& a, const Double3& b, const Double3& c, const Double3& d) {
    return {difference(a.x, d.x), difference(a.y, d.y), difference(a.z, d.z),
            difference(b.x, d.x), difference(b.y, d.y), difference(b.z, d.z),
            difference(c.x, d.x), difference(c.y, d.y), difference(c.z, d.z)};
}

Double3 scaled_by(int exponent, const Double3& p) {
    return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

int orient3d_wide(const Double3& a, const Double3& b, const Double3& c, const Double3& d) {
    const WideInteger ax = wide_difference(a.x, d.x), ay = wide_difference(a.y, d.y);
    const WideInteger az = wide_difference(a.z, d.z), bx = wide_difference(b.x, d.x);
    const WideInteger by = wide_difference(b.y, d.y), bz = wide_difference(b.z, d.z);
    const WideInteger cx = wide_difference(c.x, d.x), cy = wide_difference(c.y, d.y);
    const WideInteger cz = wide_difference(c.z, d.z);
    return (ax * (by * cz - bz * cy) + bx * (cy * az - cz * ay) + cx * (ay * bz - az * by)).sign();
}

}  // namespace

int orient2d(const Double2& a, const Double2& b, const Double2& c) noexcept {
    const double ax = a.x - c.x, ay = a.y - c.y;
    const double bx = b.x - c.x, by = b.y - c.y;
    const double left = ax * by, right = ay * bx;
    const double determinant = left - right;
    const double size = std::fabs(left) + std::fabs(right);
    const double most = std::max({std::fabs(ax), std::fabs(ay), std::fabs(bx), std::fabs(by)});
    if (most < kLargestForFilter2d && size > kLeastForFilter2d &&
        std::fabs(determinant) > kFilter2d * size) {
        return sign_of(determinant);
    }
    if ((ax == 0 || by == 0) && (ay == 0 || bx == 0)) return 0;
    return orient2d_beyond_filter(a, b, c);
}

int orient3d_beyond_filter(const Double3& a, const Double3& b, const Double3& c,
                           const Double3& d) noexcept {
    if (a == d || b == d || c == d || a == b || b == c || c == a) return 0;
    const auto x = scaled_axis<3>({a.x, b.x, c.x}, d.x, kIntegerBits);
    const auto y = scaled_axis<3>({a.y, b.y, c.y}, d.y, kIntegerBits);
    const auto z = scaled_axis<3>({a.z, b.z, c.z}, d.z, kIntegerBits);
    if (x.fits && y.fits && z.fits) {
        const auto at = [&](std::size_t i) { return Integer3{x.at[i], y.at[i], z.at[i]}; };
        return orient3d(at(0), at(1), at(2), {0, 0, 0});
    }
    const Expanded3 rows = expanded(a, b, c, d);
    if (rows.safe()) return rows.sign();
    Spread spread;
    for (const Double3& p : {a, b, c, d}) {
        for (const double value : {p.x, p.y, p.z}) widen(spread, value);
    }
    const Scale scale = find_scale(spread, 3);
    if (!scale.possible) return orient3d_wide(a, b, c, d);
    const int e = scale.exponent;
    return expanded(scaled_by(e, a), scaled_by(e, b), scaled_by(e, c), scaled_by(e, d)).sign();
}

}  // namespace cdprep
