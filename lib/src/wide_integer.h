// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cdprep {

/// A signed integer of fixed width for the rarest stage of the predicates: any
/// double is an integer multiple of 2^-1074, so a determinant of three
/// differences of doubles up to 2^1000 fits 6,300 bits. Slow (a product takes
/// microseconds) and obviously right. Never allocates.
class WideInteger {
public:
    /// value * 2^1074, which is an integer. |value| <= 2^1001.
    [[nodiscard]] static WideInteger from_double(double value) noexcept;

    [[nodiscard]] int sign() const noexcept;

    friend WideInteger operator+(const WideInteger& a, const WideInteger& b) noexcept;
    friend WideInteger operator-(const WideInteger& a, const WideInteger& b) noexcept;
    friend WideInteger operator*(const WideInteger& a, const WideInteger& b) noexcept;

private:
    static constexpr std::size_t kLimbs = 198;  ///< of 32 bits: 6,336 bits
    using Limbs = std::array<std::uint32_t, kLimbs>;

    void trim() noexcept;
    static int compare(const WideInteger& a, const WideInteger& b) noexcept;
    static WideInteger add_sizes(const WideInteger& a, const WideInteger& b) noexcept;
    static WideInteger subtract_sizes(const WideInteger& a, const WideInteger& b) noexcept;

    Limbs limb_{};
    std::size_t size_ = 0;  ///< limbs in use; 0 is zero
    bool negative_ = false;
};

}  // namespace cdprep
