// SPDX-License-Identifier: MIT
#include "predicates.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>

#include "expansion.h"
#include "wide_integer.h"

// Three stages, each exact when it answers:
//
// 1. A semi-static filter. The differences carry a relative error of u = 2^-53,
//    the determinant of rounded differences is off by at most a few u times the
//    product of the largest difference per axis; the constants below are those
//    bounds with room for their own rounding. They hold while no product over-
//    or underflows, hence the limits on the largest differences.
// 2. Expansions of the exact differences (two components each; one where the
//    difference is exact, which floats and grids nearly always give: then the
//    work shrinks by itself because zero components are dropped).
//    Exact while products of three stay in range. All coordinates are multiples
//    of 2^lowest, so a product of three differences is a multiple of
//    2^(3 lowest) and representable without loss when 3 lowest >= -1074, after
//    scaling by a power of two that brings the largest below 2^300.
// 3. Integers wide enough for any doubles, when the exponents spread further.

static_assert(FLT_EVAL_METHOD == 0, "double must be evaluated in double");

namespace cdprep {
namespace {

constexpr double kFilter2d = 4.0 * 0x1p-53 * 1.0625;  ///< 3 u + 16 u^2, rounded up
constexpr double kFilter3d = 5.1107127829973299e-15;  ///< 46 u; ALGORITHMS 1.7
constexpr double kLeastForFilter3d = 1e-97;           ///< cube stays normal
constexpr double kLargestForFilter3d = 1e102;         ///< cube stays finite
constexpr double kLeastForFilter2d = 1e-290;   ///< a product that underflows is no longer seen
constexpr double kLargestForFilter2d = 1e150;  ///< products stay finite

int sign_of(double value) {
    return (value > 0) - (value < 0);
}

/// Exponents of the highest and lowest bits over all coordinates.
struct Spread {
    int highest = -2000;
    int lowest = 2000;
};

void widen(Spread& spread, double value) {
    if (value == 0) return;
    int exponent = 0;
    const double fraction = std::frexp(std::fabs(value), &exponent);
    auto mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    int zeros = 0;
    while ((mantissa & 1) == 0) {
        mantissa >>= 1;
        ++zeros;
    }
    spread.highest = std::max(spread.highest, exponent);
    spread.lowest = std::min(spread.lowest, exponent - 53 + zeros);
}

/// The power of two that brings all coordinates below 2^300; nothing when their
/// lowest bit would then be too low for products of `factors`.
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

/// det[a-c, b-c] of plane coordinates.
template <class Number, class Difference>
auto determinant2(const Double2& a, const Double2& b, const Double2& c, Difference minus) {
    const Number ax = minus(a.x, c.x), ay = minus(a.y, c.y);
    const Number bx = minus(b.x, c.x), by = minus(b.y, c.y);
    return ax * by - ay * bx;
}

int orient2d_expanded(const Double2& a, const Double2& b, const Double2& c, int exponent) {
    const auto minus = [exponent](double x, double y) {
        return difference(std::ldexp(x, exponent), std::ldexp(y, exponent));
    };
    const auto ax = minus(a.x, c.x), ay = minus(a.y, c.y);
    const auto bx = minus(b.x, c.x), by = minus(b.y, c.y);
    return sum(product(ax, by), negated(product(ay, bx))).sign();
}

WideInteger wide_difference(double a, double b) {
    return WideInteger::from_double(a) - WideInteger::from_double(b);
}

int orient2d_exact(const Double2& a, const Double2& b, const Double2& c) {
    Spread spread;
    for (const double value : {a.x, a.y, b.x, b.y, c.x, c.y}) widen(spread, value);
    const Scale scale = find_scale(spread, 2);
    if (scale.possible) return orient2d_expanded(a, b, c, scale.exponent);
    return determinant2<WideInteger>(a, b, c, wide_difference).sign();
}

int orient3d_expanded(const Double3& a, const Double3& b, const Double3& c, const Double3& d,
                      int exponent) {
    const auto minus = [exponent](double x, double y) {
        return difference(std::ldexp(x, exponent), std::ldexp(y, exponent));
    };
    const auto ax = minus(a.x, d.x), ay = minus(a.y, d.y), az = minus(a.z, d.z);
    const auto bx = minus(b.x, d.x), by = minus(b.y, d.y), bz = minus(b.z, d.z);
    const auto cx = minus(c.x, d.x), cy = minus(c.y, d.y), cz = minus(c.z, d.z);
    const auto minor_a = sum(product(by, cz), negated(product(bz, cy)));
    const auto minor_b = sum(product(cy, az), negated(product(cz, ay)));
    const auto minor_c = sum(product(ay, bz), negated(product(az, by)));
    return sum(sum(product(minor_a, ax), product(minor_b, bx)), product(minor_c, cx)).sign();
}

int orient3d_wide(const Double3& a, const Double3& b, const Double3& c, const Double3& d) {
    const WideInteger ax = wide_difference(a.x, d.x), ay = wide_difference(a.y, d.y);
    const WideInteger az = wide_difference(a.z, d.z), bx = wide_difference(b.x, d.x);
    const WideInteger by = wide_difference(b.y, d.y), bz = wide_difference(b.z, d.z);
    const WideInteger cx = wide_difference(c.x, d.x), cy = wide_difference(c.y, d.y);
    const WideInteger cz = wide_difference(c.z, d.z);
    return (ax * (by * cz - bz * cy) + bx * (cy * az - cz * ay) + cx * (ay * bz - az * by)).sign();
}

int orient3d_exact(const Double3& a, const Double3& b, const Double3& c, const Double3& d) {
    Spread spread;
    for (const Double3& p : {a, b, c, d}) {
        widen(spread, p.x);
        widen(spread, p.y);
        widen(spread, p.z);
    }
    const Scale scale = find_scale(spread, 3);
    if (scale.possible) return orient3d_expanded(a, b, c, d, scale.exponent);
    return orient3d_wide(a, b, c, d);
}

double largest(double a, double b, double c) {
    return std::max({std::fabs(a), std::fabs(b), std::fabs(c)});
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
    return orient2d_exact(a, b, c);
}

int orient3d(const Double3& a, const Double3& b, const Double3& c, const Double3& d) noexcept {
    const double ax = a.x - d.x, ay = a.y - d.y, az = a.z - d.z;
    const double bx = b.x - d.x, by = b.y - d.y, bz = b.z - d.z;
    const double cx = c.x - d.x, cy = c.y - d.y, cz = c.z - d.z;
    const double mx = largest(ax, bx, cx);
    const double my = largest(ay, by, cy);
    const double mz = largest(az, bz, cz);
    const double least = std::min({mx, my, mz});
    if (least == 0)
        return 0;  // a flat axis: gradual underflow makes differences of unequal
                   // numbers non-zero, so this is exact
    if (least >= kLeastForFilter3d && std::max({mx, my, mz}) < kLargestForFilter3d) {
        const double determinant =
            ax * (by * cz - bz * cy) + bx * (cy * az - cz * ay) + cx * (ay * bz - az * by);
        if (std::fabs(determinant) > kFilter3d * mx * my * mz) return sign_of(determinant);
    }
    return orient3d_exact(a, b, c, d);
}

}  // namespace cdprep
