// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <limits>
#include <type_traits>
#if defined(_MSC_VER) && !defined(__clang__)
#include <intrin.h>
#endif

/// Features that compilers provide in different ways.
namespace cdprep::format {

/// A replacement for std::bit_cast, which older libraries lack. The types must have the same size.
template <class To, class From>
[[nodiscard]] constexpr To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
#if defined(__cpp_lib_bit_cast)
    return std::bit_cast<To>(from);
#else
    return __builtin_bit_cast(To, from);  // a builtin of Clang
#endif
}

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Kernels call the next three functions. Kernels are compiled for different instruction sets. The
// functions are static, so each source file has its own copies. Otherwise a linker could keep one
// copy for all callers, with instructions that the processor lacks.

/// Returns the position of the lowest set bit, counted from 0. At least one bit must be set. Faster
/// than std::countr_zero(), which also accepts 0.
[[nodiscard]] static inline unsigned lowest_set_bit(std::uint32_t bits) noexcept {
#if defined(__GNUC__)
    return static_cast<unsigned>(__builtin_ctz(bits));
#else
    unsigned long number = 0;
    _BitScanForward(&number, bits);
    return number;
#endif
}
[[nodiscard]] static inline unsigned lowest_set_bit(std::uint64_t bits) noexcept {
#if defined(__GNUC__)
    return static_cast<unsigned>(__builtin_ctzll(bits));
#else
    unsigned long number = 0;
    _BitScanForward64(&number, bits);
    return number;
#endif
}

/// Returns how many bits are set.
[[nodiscard]] static inline unsigned count_set_bits(std::uint32_t bits) noexcept {
#if defined(__GNUC__)
    return static_cast<unsigned>(__builtin_popcount(bits));
#else
    bits -= bits >> 1 & 0x55555555;
    bits = (bits & 0x33333333) + (bits >> 2 & 0x33333333);
    return ((bits + (bits >> 4)) & 0x0f0f0f0f) * 0x01010101 >> 24;
#endif
}

/// Tells the processor that the cache line of `address` will be needed soon. Any address is
/// allowed. Does nothing with Visual C++.
inline void prefetch_line([[maybe_unused]] const void* address) noexcept {
#if defined(__GNUC__)
    __builtin_prefetch(address);
#endif
}

/// A signed integer of 128 bits for compilers that have none. Arithmetic wraps around on overflow.
class TwoWordInteger {
public:
    constexpr TwoWordInteger() noexcept = default;
    template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
    // NOLINTNEXTLINE(google-explicit-constructor): like the built-in integers
    constexpr TwoWordInteger(Integer value) noexcept
        : high_(value < Integer{0} ? -1 : 0), low_(static_cast<std::uint64_t>(value)) {}

    /// Returns the lowest 64 bits.
    constexpr explicit operator std::uint64_t() const noexcept {
        return low_;
    }
    friend constexpr TwoWordInteger operator+(const TwoWordInteger& a,
                                              const TwoWordInteger& b) noexcept {
        const std::uint64_t low = a.low_ + b.low_;
        return {a.high() + b.high() + (low < a.low_ ? 1U : 0U), low};
    }
    friend constexpr TwoWordInteger operator-(const TwoWordInteger& a,
                                              const TwoWordInteger& b) noexcept {
        return {a.high() - b.high() - (a.low_ < b.low_ ? 1U : 0U), a.low_ - b.low_};
    }
    friend constexpr TwoWordInteger operator*(const TwoWordInteger& a,
                                              const TwoWordInteger& b) noexcept {
        const TwoWordInteger low = product(a.low_, b.low_);
        return {low.high() + a.high() * b.low_ + a.low_ * b.high(), low.low_};
    }
    constexpr TwoWordInteger& operator+=(const TwoWordInteger& other) noexcept {
        return *this = *this + other;
    }
    /// Returns the number divided by 2^64, rounded down.
    [[nodiscard]] constexpr TwoWordInteger upper_word() const noexcept {
        return high_;
    }
    constexpr auto operator<=>(const TwoWordInteger&) const noexcept = default;

private:
    constexpr TwoWordInteger(std::uint64_t high, std::uint64_t low) noexcept
        : high_(static_cast<std::int64_t>(high)), low_(low) {}
    [[nodiscard]] constexpr std::uint64_t high() const noexcept {
        return static_cast<std::uint64_t>(high_);
    }
    static constexpr TwoWordInteger product(std::uint64_t a, std::uint64_t b) noexcept {
        constexpr std::uint64_t kHalf = 0xffffffff;
        const std::uint64_t a0 = a & kHalf, a1 = a >> 32, b0 = b & kHalf, b1 = b >> 32;
        const std::uint64_t low = a0 * b0;
        const std::uint64_t middle = a1 * b0 + (low >> 32);
        const std::uint64_t other = a0 * b1 + (middle & kHalf);
        return {a1 * b1 + (middle >> 32) + (other >> 32), (other << 32) | (low & kHalf)};
    }

    std::int64_t high_ = 0;
    std::uint64_t low_ = 0;
};

#if defined(__SIZEOF_INT128__)
__extension__ typedef __int128 Int128;  // NOLINT(modernize-use-using)
[[nodiscard]] constexpr Int128 upper_word(Int128 a) noexcept {
    return a >> 64;
}
#else
using Int128 = TwoWordInteger;
#endif
[[nodiscard]] constexpr TwoWordInteger upper_word(const TwoWordInteger& a) noexcept {
    return a.upper_word();
}

}  // namespace cdprep::format
