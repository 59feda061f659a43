// SPDX-License-Identifier: MIT
#include "support/exact_rational.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace cdprep::test {
namespace {

using Digits = std::vector<std::uint32_t>;

constexpr int kDigitBits = 32;

void drop_leading_zeros(Digits& digits) {
    while (!digits.empty() && digits.back() == 0) digits.pop_back();
}

/// Digits above as many zeros, which are stored nowhere.
struct Shifted {
    const Digits& digits;
    std::size_t zeros;

    [[nodiscard]] std::size_t size() const {
        return zeros + digits.size();
    }
    [[nodiscard]] std::uint32_t operator[](std::size_t i) const {
        return i < zeros || i >= size() ? 0 : digits[i - zeros];
    }
};

/// -1, 0 or 1. Both without zero digits at the top.
int compare(const Shifted& a, const Shifted& b) {
    if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
    for (std::size_t i = a.size(); i-- > 0;) {
        if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    }
    return 0;
}

Digits add(const Shifted& a, const Shifted& b) {
    Digits result(std::max(a.size(), b.size()) + 1);
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < result.size(); ++i) {
        carry += std::uint64_t{a[i]} + b[i];
        result[i] = static_cast<std::uint32_t>(carry);
        carry >>= kDigitBits;
    }
    return result;
}

/// a - b for a >= b.
Digits subtract(const Shifted& a, const Shifted& b) {
    Digits result(a.size());
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < result.size(); ++i) {
        std::int64_t digit = std::int64_t{a[i]} - b[i] - borrow;
        borrow = digit < 0 ? 1 : 0;
        if (digit < 0) digit += std::int64_t{1} << kDigitBits;
        result[i] = static_cast<std::uint32_t>(digit);
    }
    return result;
}

Digits multiply(const Digits& a, const Digits& b) {
    Digits result(a.size() + b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; j < b.size(); ++j) {
            carry += std::uint64_t{a[i]} * b[j] + result[i + j];
            result[i + j] = static_cast<std::uint32_t>(carry);
            carry >>= kDigitBits;
        }
        result[i + b.size()] = static_cast<std::uint32_t>(carry);
    }
    drop_leading_zeros(result);
    return result;
}

}  // namespace

ExactNumber::ExactNumber(double value) : negative_(value < 0) {
    if (value == 0) return;
    int exponent = 0;
    const double fraction = std::frexp(std::fabs(value), &exponent);
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    const int lowest = exponent - 53;
    const int bits = ((lowest % kDigitBits) + kDigitBits) % kDigitBits;
    exponent_ = lowest - bits;
    magnitude_ = multiply(
        {static_cast<std::uint32_t>(mantissa), static_cast<std::uint32_t>(mantissa >> kDigitBits)},
        {std::uint32_t{1} << bits});
    normalise();
}

void ExactNumber::normalise() {
    drop_leading_zeros(magnitude_);
    const auto first = std::find_if(magnitude_.begin(), magnitude_.end(),
                                    [](std::uint32_t digit) { return digit != 0; });
    exponent_ += kDigitBits * static_cast<int>(first - magnitude_.begin());
    magnitude_.erase(magnitude_.begin(), first);
    if (magnitude_.empty()) {
        exponent_ = 0;
        negative_ = false;
    }
}

int ExactNumber::sign() const {
    if (magnitude_.empty()) return 0;
    return negative_ ? -1 : 1;
}

long double ExactNumber::approximation() const {
    long double result = 0;
    for (std::size_t i = magnitude_.size(); i-- > 0 && i + 3 >= magnitude_.size();) {
        result += std::ldexp(static_cast<long double>(magnitude_[i]),
                             exponent_ + kDigitBits * static_cast<int>(i));
    }
    return negative_ ? -result : result;
}

ExactNumber operator-(ExactNumber a) {
    a.negative_ = !a.negative_ && !a.magnitude_.empty();
    return a;
}

ExactNumber ExactNumber::sum(const ExactNumber& a, const ExactNumber& b, bool b_is_negative) {
    ExactNumber result;
    result.exponent_ = a.magnitude_.empty()   ? b.exponent_
                       : b.magnitude_.empty() ? a.exponent_
                                              : std::min(a.exponent_, b.exponent_);
    const auto shifted = [&](const ExactNumber& number) {
        const int zeros = (number.exponent_ - result.exponent_) / kDigitBits;
        return Shifted{number.magnitude_,
                       number.magnitude_.empty() ? 0 : static_cast<std::size_t>(zeros)};
    };
    const Shifted x = shifted(a), y = shifted(b);
    if (a.negative_ == b_is_negative) {
        result.magnitude_ = add(x, y);
        result.negative_ = a.negative_;
    } else if (compare(x, y) >= 0) {
        result.magnitude_ = subtract(x, y);
        result.negative_ = a.negative_;
    } else {
        result.magnitude_ = subtract(y, x);
        result.negative_ = b_is_negative;
    }
    result.normalise();
    return result;
}

ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
    return ExactNumber::sum(a, b, b.negative_);
}

ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) {
    return ExactNumber::sum(a, b, !b.negative_);
}

ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
    ExactNumber result;
    result.magnitude_ = multiply(a.magnitude_, b.magnitude_);
    result.exponent_ = a.exponent_ + b.exponent_;
    result.negative_ = a.negative_ != b.negative_;
    result.normalise();
    return result;
}

ExactRational::ExactRational(ExactNumber numerator, ExactNumber denominator)
    : numerator_(std::move(numerator)), denominator_(std::move(denominator)) {
    if (denominator_.sign() < 0) {
        numerator_ = -numerator_;
        denominator_ = -denominator_;
    }
}

ExactRational operator+(const ExactRational& a, const ExactRational& b) {
    if (a.denominator_ == b.denominator_) {
        return {a.numerator_ + b.numerator_, a.denominator_};
    }
    return {a.numerator_ * b.denominator_ + b.numerator_ * a.denominator_,
            a.denominator_ * b.denominator_};
}

ExactRational operator-(const ExactRational& a, const ExactRational& b) {
    return a + ExactRational(-b.numerator_, b.denominator_);
}

ExactRational operator*(const ExactRational& a, const ExactRational& b) {
    return {a.numerator_ * b.numerator_, a.denominator_ * b.denominator_};
}

ExactRational operator/(const ExactRational& a, const ExactRational& b) {
    return {a.numerator_ * b.denominator_, a.denominator_ * b.numerator_};
}

}  // namespace cdprep::test
