// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "expansion.h"

namespace cdprep {

/// Points whose differences are at most 2^62 + 2^9 in size per coordinate: all signs
/// below are then exact in machine integers.
struct Integer3 {
    std::int64_t x, y, z;
    friend bool operator==(const Integer3&, const Integer3&) = default;
};
struct Integer2 {
    std::int64_t x, y;
};

/// Returns exact differences, a value and what its rounding lost each, as integers:
/// all times the power of two that puts the largest between 2^(bits - 1) and
/// 2^bits (plus 2^(bits - 53)). Nothing when they spread over more than `bits`
/// bits: floats, grids, and corners that lie near each other seldom do. `bits` is at
/// most 62.
template <std::size_t N>
[[nodiscard]] std::optional<std::array<std::int64_t, N>> scaled_integers(
    const std::array<Exact2, N>& differences, int bits) noexcept;

extern template std::optional<std::array<std::int64_t, 4>> scaled_integers(
    const std::array<Exact2, 4>& differences, int bits) noexcept;
extern template std::optional<std::array<std::int64_t, 9>> scaled_integers(
    const std::array<Exact2, 9>& differences, int bits) noexcept;
extern template std::optional<std::array<std::int64_t, 15>> scaled_integers(
    const std::array<Exact2, 15>& differences, int bits) noexcept;

/// As the functions of the same names for doubles (predicates.h).
[[nodiscard]] int orient2d(const Integer2& a, const Integer2& b, const Integer2& c) noexcept;
[[nodiscard]] int orient3d(const Integer3& a, const Integer3& b, const Integer3& c,
                           const Integer3& d) noexcept;
[[nodiscard]] std::array<int, 3> plane_signs(const std::array<Integer3, 3>& plane,
                                             const std::array<Integer3, 3>& points) noexcept;

}  // namespace cdprep
