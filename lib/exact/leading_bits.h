// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "exact/double_double.h"
#include "exact/wide_integer.h"

namespace cdprep {

/// The first bits of a wide integer: fraction * 2^exponent.
struct LeadingBits {
    DoubleDouble fraction;
    int exponent;
};

/// Returns the first 129 bits or more, rounded to twice the precision of double.
template <std::size_t kLimbs>
LeadingBits leading_bits(const WideInteger<kLimbs>& a) noexcept {
    constexpr std::size_t kMost = 5;
    constexpr int kBits = 32;
    const WideView view = a.view();
    const std::size_t skipped = view.size - std::min(kMost, view.size);
    DoubleDouble sum = 0.0;
    for (std::size_t i = view.size; i-- > skipped;) {
        const double limb = std::ldexp(view.limb[i], kBits * static_cast<int>(i - skipped));
        sum = sum + DoubleDouble(view.negative ? -limb : limb);
    }
    return {sum, kBits * static_cast<int>(skipped)};
}

/// Returns a / b * 2^exponent. Its error before the final rounding is below 2^-98 of itself.
inline double quotient(const LeadingBits& a, const LeadingBits& b, int exponent) noexcept {
    const DoubleDouble fraction = a.fraction / b.fraction;
    return std::ldexp(static_cast<double>(fraction), a.exponent - b.exponent + exponent);
}

}  // namespace cdprep
