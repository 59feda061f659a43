// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/exact_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace cdprep::mesh {
namespace {

__extension__ typedef unsigned __int128 Uint128;  // NOLINT(modernize-use-using)

constexpr int kLimbBits = 64;
constexpr int kLeastExponent = -1074;  // of the least subnormal number

/// |value| = mantissa * 2^(exponent - 1074).
struct Whole {
    std::uint64_t mantissa;
    int exponent;  ///< >= 0
};

Whole whole_of(double value) {
    constexpr int kMantissaBits = 52;
    constexpr std::uint64_t kFraction = (std::uint64_t{1} << kMantissaBits) - 1;
    const auto bits = std::bit_cast<std::uint64_t>(std::fabs(value));
    const auto biased = static_cast<int>(bits >> kMantissaBits);
    if (biased == 0) return {bits, 0};
    return {(bits & kFraction) | (std::uint64_t{1} << kMantissaBits), biased - 1};
}

}  // namespace

void ExactVolume::add(const format::Double3& a, const format::Double3& b,
                      const format::Double3& c) {
    add_product(a.x, b.y, c.z, false);
    add_product(a.x, b.z, c.y, true);
    add_product(a.y, b.z, c.x, false);
    add_product(a.y, b.x, c.z, true);
    add_product(a.z, b.x, c.y, false);
    add_product(a.z, b.y, c.x, true);
}

void ExactVolume::add_product(double x, double y, double z, bool subtract) {
    if (x == 0 || y == 0 || z == 0) return;
    const bool negative = (std::signbit(x) != std::signbit(y)) != (std::signbit(z) != subtract);
    Limbs& sum = negative ? negative_ : positive_;
    const Whole u = whole_of(x);
    const Whole v = whole_of(y);
    const Whole w = whole_of(z);
    // 159 bits in three limbs.
    const Uint128 two = static_cast<Uint128>(u.mantissa) * v.mantissa;
    const Uint128 low = static_cast<Uint128>(static_cast<std::uint64_t>(two)) * w.mantissa;
    const Uint128 high =
        static_cast<Uint128>(static_cast<std::uint64_t>(two >> kLimbBits)) * w.mantissa +
        static_cast<std::uint64_t>(low >> kLimbBits);
    const std::array<std::uint64_t, 3> limb = {static_cast<std::uint64_t>(low),
                                               static_cast<std::uint64_t>(high),
                                               static_cast<std::uint64_t>(high >> kLimbBits)};
    const int exponent = u.exponent + v.exponent + w.exponent;
    const auto first = static_cast<std::size_t>(exponent / kLimbBits);
    const int shift = exponent % kLimbBits;
    for (std::size_t i = 0; i < limb.size(); ++i) {
        add_at(sum, first + i, limb[i] << shift);
        if (shift > 0) add_at(sum, first + i + 1, limb[i] >> (kLimbBits - shift));
    }
}

void ExactVolume::add_at(Limbs& sum, std::size_t limb, std::uint64_t value) {
    while (value != 0) {
        sum[limb] += value;
        value = sum[limb] < value ? 1 : 0;
        ++limb;
    }
}

int ExactVolume::sign() const {
    for (std::size_t i = kLimbs; i-- > 0;) {
        if (positive_[i] != negative_[i]) return positive_[i] > negative_[i] ? 1 : -1;
    }
    return 0;
}

ExactVolume::Limbs ExactVolume::difference(const Limbs& larger, const Limbs& smaller) {
    Limbs result{};
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < kLimbs; ++i) {
        const std::uint64_t taken = smaller[i] + borrow;
        // `taken` wraps to 0 only if the borrow propagates unchanged.
        const bool wrapped = borrow != 0 && taken == 0;
        result[i] = larger[i] - taken;
        borrow = wrapped || larger[i] < taken ? 1 : 0;
    }
    return result;
}

double ExactVolume::as_double(const Limbs& sum) {
    std::size_t top = kLimbs;
    while (top > 0 && sum[top - 1] == 0) --top;
    // Two limbs hold more digits than a double.
    double value = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(top, 2); ++i) {
        value = value * 0x1p64 + static_cast<double>(sum[top - 1 - i]);
    }
    constexpr double kSix = 6;
    const auto lowest = static_cast<int>(top > 2 ? top - 2 : 0);
    const double volume = std::ldexp(value / kSix, lowest * kLimbBits + 3 * kLeastExponent);
    return std::min(volume, std::numeric_limits<double>::max());
}

double ExactVolume::volume() const {
    switch (sign()) {
        case 1:
            return as_double(difference(positive_, negative_));
        case -1:
            return -as_double(difference(negative_, positive_));
        default:
            return 0;
    }
}

}  // namespace cdprep::mesh
