// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "cdprep/format/portable.h"

namespace cdprep {

/// Returns 2^exponent; without a library call if the result is a normal number.
inline double two_to(int exponent) noexcept {
    constexpr int kBias = 1023;
    if (exponent <= -kBias || exponent > kBias) return std::ldexp(1.0, exponent);
    return format::bit_cast<double>(static_cast<std::uint64_t>(exponent + kBias) << 52);
}

/// Multiplies by 2^exponent in two steps. No step leaves the range unless the result does.
class Scale {
public:
    explicit Scale(int exponent) noexcept
        : first_(two_to(exponent / 2)), second_(two_to(exponent - exponent / 2)) {}

    double operator()(double x) const noexcept {
        return x * first_ * second_;
    }

    /// The two factors, in the order of their use.
    [[nodiscard]] double first() const noexcept {
        return first_;
    }
    [[nodiscard]] double second() const noexcept {
        return second_;
    }

private:
    double first_;
    double second_;
};

/// Returns x * 2^exponent.
inline double scaled(double x, int exponent) noexcept {
    return Scale(exponent)(x);
}

}  // namespace cdprep
