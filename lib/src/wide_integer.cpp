// SPDX-License-Identifier: MIT
#include "wide_integer.h"

#include <algorithm>
#include <cmath>

namespace cdprep {
namespace {

constexpr int kLowestExponent = -1074;  ///< of the least subnormal double
constexpr unsigned kLimbBits = 32;

}  // namespace

WideInteger WideInteger::from_double(double value) noexcept {
    WideInteger result;
    if (value == 0) return result;
    int exponent = 0;
    const double fraction = std::frexp(std::fabs(value), &exponent);
    auto mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    int shift = exponent - 53 - kLowestExponent;
    while (shift < 0) {  // a subnormal: its low bits are zero
        mantissa >>= 1;
        ++shift;
    }
    const auto limb = static_cast<std::size_t>(shift) / kLimbBits;
    const unsigned bits = static_cast<unsigned>(shift) % kLimbBits;
    result.limb_[limb] = static_cast<std::uint32_t>(mantissa << bits);
    result.limb_[limb + 1] = static_cast<std::uint32_t>((mantissa >> (kLimbBits - bits)));
    if (bits == 0) result.limb_[limb + 1] = static_cast<std::uint32_t>(mantissa >> kLimbBits);
    if (bits != 0) {
        result.limb_[limb + 2] = static_cast<std::uint32_t>(mantissa >> (2 * kLimbBits - bits));
    }
    result.size_ = limb + 3;
    result.trim();
    result.negative_ = value < 0;
    return result;
}

int WideInteger::sign() const noexcept {
    if (size_ == 0) return 0;
    return negative_ ? -1 : 1;
}

void WideInteger::trim() noexcept {
    while (size_ > 0 && limb_[size_ - 1] == 0) --size_;
    if (size_ == 0) negative_ = false;
}

/// Compares magnitudes.
int WideInteger::compare(const WideInteger& a, const WideInteger& b) noexcept {
    if (a.size_ != b.size_) return a.size_ < b.size_ ? -1 : 1;
    for (std::size_t i = a.size_; i-- > 0;) {
        if (a.limb_[i] != b.limb_[i]) return a.limb_[i] < b.limb_[i] ? -1 : 1;
    }
    return 0;
}

WideInteger WideInteger::add_sizes(const WideInteger& a, const WideInteger& b) noexcept {
    WideInteger result;
    result.size_ = std::min(kLimbs, std::max(a.size_, b.size_) + 1);
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < result.size_; ++i) {
        carry += std::uint64_t{a.limb_[i]} + b.limb_[i];
        result.limb_[i] = static_cast<std::uint32_t>(carry);
        carry >>= kLimbBits;
    }
    result.trim();
    return result;
}

/// |a| - |b| for |a| >= |b|.
WideInteger WideInteger::subtract_sizes(const WideInteger& a, const WideInteger& b) noexcept {
    WideInteger result;
    result.size_ = a.size_;
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < a.size_; ++i) {
        std::int64_t digit = std::int64_t{a.limb_[i]} - b.limb_[i] - borrow;
        borrow = digit < 0 ? 1 : 0;
        if (digit < 0) digit += std::int64_t{1} << kLimbBits;
        result.limb_[i] = static_cast<std::uint32_t>(digit);
    }
    result.trim();
    return result;
}

WideInteger operator+(const WideInteger& a, const WideInteger& b) noexcept {
    if (a.negative_ == b.negative_) {
        WideInteger result = WideInteger::add_sizes(a, b);
        result.negative_ = a.negative_ && result.size_ > 0;
        return result;
    }
    const bool a_larger = WideInteger::compare(a, b) >= 0;
    WideInteger result =
        a_larger ? WideInteger::subtract_sizes(a, b) : WideInteger::subtract_sizes(b, a);
    result.negative_ = result.size_ > 0 && (a_larger ? a.negative_ : b.negative_);
    return result;
}

WideInteger operator-(const WideInteger& a, const WideInteger& b) noexcept {
    WideInteger negated = b;
    negated.negative_ = b.size_ > 0 && !b.negative_;
    return a + negated;
}

WideInteger operator*(const WideInteger& a, const WideInteger& b) noexcept {
    WideInteger result;
    result.size_ = std::min(WideInteger::kLimbs, a.size_ + b.size_);
    for (std::size_t i = 0; i < a.size_; ++i) {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; i + j < result.size_; ++j) {
            carry += std::uint64_t{a.limb_[i]} * b.limb_[j] + result.limb_[i + j];
            result.limb_[i + j] = static_cast<std::uint32_t>(carry);
            carry >>= kLimbBits;
        }
    }
    result.negative_ = a.negative_ != b.negative_;
    result.trim();
    return result;
}

}  // namespace cdprep
