// SPDX-License-Identifier: MIT
#include "exact/wide_integer.h"

#include <bit>
#include <cmath>

namespace cdprep {
namespace {

constexpr unsigned kLimbBits = 32;

/// Returns the size without zero limbs at the top.
std::size_t trimmed(const std::uint32_t* limb, std::size_t size) noexcept {
    while (size > 0 && limb[size - 1] == 0) --size;
    return size;
}

/// Compares magnitudes.
int compare(const WideView& a, const WideView& b) noexcept {
    if (a.size != b.size) return a.size < b.size ? -1 : 1;
    for (std::size_t i = a.size; i-- > 0;) {
        if (a.limb[i] != b.limb[i]) return a.limb[i] < b.limb[i] ? -1 : 1;
    }
    return 0;
}

/// Writes |a| + |b|. Requires that a is not shorter.
std::size_t add_sizes(const WideView& a, const WideView& b, std::uint32_t* limb) noexcept {
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < a.size; ++i) {
        carry += std::uint64_t{a.limb[i]} + (i < b.size ? b.limb[i] : 0);
        limb[i] = static_cast<std::uint32_t>(carry);
        carry >>= kLimbBits;
    }
    if (carry == 0) return a.size;
    limb[a.size] = static_cast<std::uint32_t>(carry);
    return a.size + 1;
}

/// Writes |a| - |b|. Requires |a| >= |b|.
std::size_t subtract_sizes(const WideView& a, const WideView& b, std::uint32_t* limb) noexcept {
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < a.size; ++i) {
        std::int64_t digit = std::int64_t{a.limb[i]} - (i < b.size ? b.limb[i] : 0) - borrow;
        borrow = digit < 0 ? 1 : 0;
        if (digit < 0) digit += std::int64_t{1} << kLimbBits;
        limb[i] = static_cast<std::uint32_t>(digit);
    }
    return trimmed(limb, a.size);
}

/// A finite number's magnitude as mantissa * 2^exponent.
struct Parts {
    std::uint64_t mantissa;
    int exponent;
};

Parts parts_of(double value) noexcept {
    int exponent = 0;
    const double fraction = std::frexp(std::fabs(value), &exponent);
    return {static_cast<std::uint64_t>(std::ldexp(fraction, 53)), exponent - 53};
}

}  // namespace

int lowest_bit(double value) noexcept {
    if (value == 0) return kLowestExponent + 3000;
    const Parts parts = parts_of(value);
    return parts.exponent + std::countr_zero(parts.mantissa);
}

WideSize wide_from_double(double value, int lowest, std::uint32_t* limb) noexcept {
    if (value == 0) return {0, false};
    auto [mantissa, exponent] = parts_of(value);
    int shift = exponent - lowest;
    if (shift < 0) {  // the low bits are zero
        mantissa >>= -shift;
        shift = 0;
    }
    const auto first = static_cast<std::size_t>(shift) / kLimbBits;
    const unsigned bits = static_cast<unsigned>(shift) % kLimbBits;
    std::fill_n(limb, first, 0);
    limb[first] = static_cast<std::uint32_t>(mantissa << bits);
    limb[first + 1] = static_cast<std::uint32_t>(mantissa >> (kLimbBits - bits));
    limb[first + 2] =
        bits == 0 ? 0 : static_cast<std::uint32_t>(mantissa >> (2 * kLimbBits - bits));
    return {trimmed(limb, first + 3), value < 0};
}

WideSize wide_sum(const WideView& a, const WideView& b, std::uint32_t* limb) noexcept {
    if (a.negative == b.negative) {
        const std::size_t size = a.size >= b.size ? add_sizes(a, b, limb) : add_sizes(b, a, limb);
        return {size, a.negative && size > 0};
    }
    const bool a_larger = compare(a, b) >= 0;
    const std::size_t size = a_larger ? subtract_sizes(a, b, limb) : subtract_sizes(b, a, limb);
    return {size, size > 0 && (a_larger ? a.negative : b.negative)};
}

WideSize wide_product(const WideView& a, const WideView& b, std::uint32_t* limb) noexcept {
    std::fill_n(limb, a.size + b.size, 0);
    for (std::size_t i = 0; i < a.size; ++i) {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; j < b.size; ++j) {
            carry += std::uint64_t{a.limb[i]} * b.limb[j] + limb[i + j];
            limb[i + j] = static_cast<std::uint32_t>(carry);
            carry >>= kLimbBits;
        }
        limb[i + b.size] = static_cast<std::uint32_t>(carry);
    }
    const std::size_t size = trimmed(limb, a.size + b.size);
    return {size, size > 0 && a.negative != b.negative};
}

}  // namespace cdprep
