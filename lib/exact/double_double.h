// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "exact/expansion.h"

namespace cdprep {

/// An unevaluated sum of two doubles with about 104 bits (Dekker 1971). A product or quotient has a
/// relative error of at most 10 * 2^-106 (Joldes, Muller and Popescu 2017). The error of a sum of
/// numbers of any sign has the same bound relative to the larger number. For differences that
/// cancel completely in double. It is 20 times slower than double.
struct DoubleDouble {
    double high = 0;
    double low = 0;

    DoubleDouble() noexcept = default;
    DoubleDouble(double value) noexcept : high(value) {}  // NOLINT(google-explicit-constructor)
    DoubleDouble(double high_part, double low_part) noexcept : high(high_part), low(low_part) {}
    [[nodiscard]] explicit operator double() const noexcept {
        return high + low;
    }
};

inline DoubleDouble renormalised(double high, double low) noexcept {
    const Exact2 sum = fast_two_sum(high, low);
    return {sum.value, sum.tail};
}

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    const Exact2 high = two_sum(a.high, b.high);
    const Exact2 low = two_sum(a.low, b.low);
    const DoubleDouble sum = renormalised(high.value, high.tail + low.value);
    return renormalised(sum.high, sum.low + low.tail);
}

inline DoubleDouble operator-(const DoubleDouble& a) noexcept {
    return {-a.high, -a.low};
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    return a + -b;
}

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    const Exact2 product = two_product(a.high, b.high);
    return renormalised(product.value, product.tail + (a.high * b.low + a.low * b.high));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    const double first = a.high / b.high;
    const DoubleDouble rest = a - b * DoubleDouble(first);
    const double second = rest.high / b.high;
    const DoubleDouble last = rest - b * DoubleDouble(second);
    return renormalised(first, second) + DoubleDouble(last.high / b.high);
}

inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
}

inline bool operator>(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    return b < a;
}

/// Returns the square root by one Newton step from the root of the leading part.
inline DoubleDouble square_root(const DoubleDouble& a) noexcept {
    if (!(a.high > 0)) return 0.0;
    const double root = std::sqrt(a.high);
    const DoubleDouble rest = a - DoubleDouble(root) * DoubleDouble(root);
    return renormalised(root, rest.high / (2 * root));
}

inline double square_root(double a) noexcept {
    return std::sqrt(a);
}

}  // namespace cdprep
