// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

namespace cdprep::test {

/// A number magnitude * 2^exponent of any size: sums, differences and products
/// of doubles, without rounding. Uses schoolbook arithmetic, so it is slow.
class ExactNumber {
public:
    ExactNumber() = default;    ///< zero
    ExactNumber(double value);  // NOLINT: implicit on purpose; finite

    [[nodiscard]] int sign() const;
    /// Returns an approximation with a relative error within 2^-62.
    [[nodiscard]] long double approximation() const;

    friend ExactNumber operator-(ExactNumber a);
    friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b);
    friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b);
    friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b);
    /// Equal numbers are stored alike.
    friend bool operator==(const ExactNumber& a, const ExactNumber& b) = default;
    friend std::strong_ordering operator<=>(const ExactNumber& a, const ExactNumber& b) {
        return (a - b).sign() <=> 0;
    }

private:
    /// The sum of a, and of b with another sign.
    static ExactNumber sum(const ExactNumber& a, const ExactNumber& b, bool b_is_negative);
    /// Removes zero digits at both ends.
    void normalise();

    std::vector<std::uint32_t> magnitude_;  ///< least digit first; empty is zero
    int exponent_ = 0;                      ///< multiple of 32
    bool negative_ = false;
};

/// A quotient of two exact numbers.
class ExactRational {
public:
    ExactRational() : ExactRational(0.0) {}
    ExactRational(double value) : ExactRational(value, 1.0) {}  // NOLINT: implicit on purpose
    /// Makes numerator / denominator. `denominator` must not be zero.
    ExactRational(ExactNumber numerator, ExactNumber denominator);

    [[nodiscard]] int sign() const {
        return numerator_.sign();
    }
    [[nodiscard]] long double approximation() const {
        return numerator_.approximation() / denominator_.approximation();
    }

    friend ExactRational operator+(const ExactRational& a, const ExactRational& b);
    friend ExactRational operator-(const ExactRational& a, const ExactRational& b);
    friend ExactRational operator*(const ExactRational& a, const ExactRational& b);
    friend ExactRational operator/(const ExactRational& a, const ExactRational& b);
    friend bool operator==(const ExactRational& a, const ExactRational& b) {
        return (a - b).sign() == 0;
    }
    friend std::strong_ordering operator<=>(const ExactRational& a, const ExactRational& b) {
        return (a - b).sign() <=> 0;
    }

private:
    ExactNumber numerator_;
    ExactNumber denominator_;  ///< > 0
};

inline ExactRational exact_square(double x) {
    return {ExactNumber(x) * ExactNumber(x), 1.0};
}

}  // namespace cdprep::test
