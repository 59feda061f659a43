// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "cdprep/format/api.h"

namespace cdprep {

/// A view of 32-bit limbs, the least first. The top limb is not zero; zero has no limbs.
struct WideView {
    const std::uint32_t* limb;
    std::size_t size;
    bool negative;
};

/// The parts of a result that are not in its limbs.
struct WideSize {
    std::size_t size;
    bool negative;
};

/// These write to `limb`, which must have enough room: a sum needs the larger size and one limb for
/// a carry, a product both sizes.
[[nodiscard]] CDPREP_API WideSize wide_sum(const WideView& a, const WideView& b,
                                           std::uint32_t* limb) noexcept;
[[nodiscard]] CDPREP_API WideSize wide_product(const WideView& a, const WideView& b,
                                               std::uint32_t* limb) noexcept;
[[nodiscard]] CDPREP_API WideSize wide_from_double(double value, int lowest,
                                                   std::uint32_t* limb) noexcept;

/// The exponent of the least subnormal double.
inline constexpr int kLowestExponent = -1074;

/// Returns the exponent of the lowest bit that is set; kLowestExponent + 3000 for 0.
[[nodiscard]] CDPREP_API int lowest_bit(double value) noexcept;

/// The number of limbs of a double, or of a difference of two, as a multiple of 2^-1074. They hold
/// 2,099 bits, and some to add up a few. A product of k factors needs k times as many.
inline constexpr std::size_t kWideCoordinate = 66;

/// A signed integer of at most `kLimbs` limbs for the rarest stage of the predicates. Every double
/// is an integer multiple of 2^-1074, and the doubles of one query are often multiples of something
/// much larger. The cost depends on the limbs in use: tens of nanoseconds an operation for everyday
/// numbers, microseconds at worst. Never allocates. Sums of up to 2^10 terms fit.
template <std::size_t kLimbs>
class WideInteger {
public:
    // Limbs past the size are never read; initialising them would cost more than the rest.
    WideInteger() noexcept {}  // NOLINT
    WideInteger(const WideInteger& other) noexcept
        : size_(other.size_), negative_(other.negative_) {
        std::copy_n(other.limb_.begin(), size_, limb_.begin());
    }
    WideInteger& operator=(const WideInteger& other) noexcept {
        size_ = other.size_;
        negative_ = other.negative_;
        std::copy_n(other.limb_.begin(), size_, limb_.begin());
        return *this;
    }
    ~WideInteger() = default;

    /// Returns value / 2^lowest, which is an integer. Requires lowest <= lowest_bit(value).
    [[nodiscard]] static WideInteger from_double(double value,
                                                 int lowest = kLowestExponent) noexcept {
        static_assert(kLimbs >= kWideCoordinate);
        assert(lowest <= lowest_bit(value));
        WideInteger result;
        result.take(wide_from_double(value, lowest, result.limb_.data()));
        return result;
    }

    [[nodiscard]] int sign() const noexcept {
        if (size_ == 0) return 0;
        return negative_ ? -1 : 1;
    }
    [[nodiscard]] WideInteger operator-() const noexcept {
        WideInteger result = *this;
        result.negative_ = size_ > 0 && !negative_;
        return result;
    }

    friend WideInteger operator+(const WideInteger& a, const WideInteger& b) noexcept {
        WideInteger result;
        result.take(wide_sum(a.view(), b.view(), result.limb_.data()));
        return result;
    }
    friend WideInteger operator-(const WideInteger& a, const WideInteger& b) noexcept {
        WideView turned = b.view();
        turned.negative = !turned.negative;
        WideInteger result;
        result.take(wide_sum(a.view(), turned, result.limb_.data()));
        return result;
    }
    template <std::size_t kOther>
    friend WideInteger<kLimbs + kOther> operator*(const WideInteger& a,
                                                  const WideInteger<kOther>& b) noexcept {
        WideInteger<kLimbs + kOther> result;
        result.take(wide_product(a.view(), b.view(), result.limbs()));
        return result;
    }

    [[nodiscard]] WideView view() const noexcept {
        return {limb_.data(), size_, negative_};
    }
    /// For the operators alone.
    [[nodiscard]] std::uint32_t* limbs() noexcept {
        return limb_.data();
    }
    void take(const WideSize& size) noexcept {
        assert(size.size <= kLimbs);
        size_ = size.size;
        negative_ = size.negative;
    }

private:
    std::array<std::uint32_t, kLimbs> limb_;
    std::size_t size_ = 0;  ///< limbs in use; 0 is zero
    bool negative_ = false;
};

}  // namespace cdprep
