// SPDX-License-Identifier: MIT
#include "integer_points.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cdprep {
namespace {

__extension__ typedef __int128 Int128;            // NOLINT(modernize-use-using)
__extension__ typedef unsigned __int128 Uint128;  // NOLINT(modernize-use-using)

constexpr unsigned kMantissaBits = 52;
constexpr int kBias = 1023;

double power_of_two(int exponent) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + kBias) << kMantissaBits);
}

/// Adds to `sum` the integer that `value` is times `scale`; false when it is none.
/// The product is below 2^63. Undone, it must give the value again: so nothing
/// fell off the lower end of double either.
bool add_scaled(double value, double scale, double unscale, std::int64_t& sum) {
    const auto integer = static_cast<std::int64_t>(value * scale);
    sum += integer;
    return static_cast<double>(integer) * unscale == value;
}

Integer3 operator-(const Integer3& a, const Integer3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// a d - b c: below 2^126.
Int128 minor_of(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
    return static_cast<Int128>(a) * d - static_cast<Int128>(b) * c;
}

struct Normal {
    Int128 x, y, z;
};

Normal cross(const Integer3& a, const Integer3& b) {
    return {minor_of(a.y, a.z, b.y, b.z), minor_of(a.z, a.x, b.z, b.x),
            minor_of(a.x, a.y, b.x, b.y)};
}

/// high * 2^64 + low, three products of a minor and a difference: each below 2^189.
class WideSum {
public:
    void add_product(Int128 minor, std::int64_t factor) noexcept {
        const Int128 low = static_cast<Int128>(static_cast<std::uint64_t>(minor)) * factor;
        high_ += (minor >> 64) * factor + (low >> 64);
        low_ += static_cast<std::uint64_t>(low);
    }
    [[nodiscard]] int sign() const noexcept {
        const Int128 high = high_ + static_cast<Int128>(low_ >> 64);
        if (high != 0) return high > 0 ? 1 : -1;
        return static_cast<std::uint64_t>(low_) != 0 ? 1 : 0;
    }

private:
    Int128 high_ = 0;
    Uint128 low_ = 0;
};

int dot_sign(const Normal& n, const Integer3& a) {
    WideSum sum;
    sum.add_product(n.x, a.x);
    sum.add_product(n.y, a.y);
    sum.add_product(n.z, a.z);
    return sum.sign();
}

}  // namespace

template <std::size_t N>
std::optional<std::array<std::int64_t, N>> scaled_integers(const std::array<Exact2, N>& differences,
                                                           int bits) noexcept {
    double most = 0;
    for (const Exact2& d : differences) most = std::max(most, std::fabs(d.value));
    const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(most) >> kMantissaBits);
    // Below 2^-960 there is no double for the scale; an infinite difference has none.
    if (exponent <= bits || exponent > 2 * kBias) return std::nullopt;
    const double scale = power_of_two(kBias + bits - 1 - exponent);
    const double unscale = power_of_two(exponent - kBias - (bits - 1));
    std::array<std::int64_t, N> result{};
    bool exact = true;
    for (std::size_t i = 0; i < N; ++i) {
        exact &= add_scaled(differences[i].value, scale, unscale, result[i]);
        exact &= add_scaled(differences[i].tail, scale, unscale, result[i]);
    }
    if (!exact) return std::nullopt;
    return result;
}

template std::optional<std::array<std::int64_t, 4>> scaled_integers(
    const std::array<Exact2, 4>& differences, int bits) noexcept;
template std::optional<std::array<std::int64_t, 9>> scaled_integers(
    const std::array<Exact2, 9>& differences, int bits) noexcept;
template std::optional<std::array<std::int64_t, 15>> scaled_integers(
    const std::array<Exact2, 15>& differences, int bits) noexcept;

int orient2d(const Integer2& a, const Integer2& b, const Integer2& c) noexcept {
    const Int128 determinant = minor_of(a.x - c.x, a.y - c.y, b.x - c.x, b.y - c.y);
    return (determinant > 0) - (determinant < 0);
}

int orient3d(const Integer3& a, const Integer3& b, const Integer3& c, const Integer3& d) noexcept {
    return dot_sign(cross(b - d, c - d), a - d);
}

std::array<int, 3> plane_signs(const std::array<Integer3, 3>& plane,
                               const std::array<Integer3, 3>& points) noexcept {
    // Turned round: orient3d is positive behind the plane.
    const Normal behind = cross(plane[2] - plane[0], plane[1] - plane[0]);
    return {dot_sign(behind, points[0] - plane[0]), dot_sign(behind, points[1] - plane[0]),
            dot_sign(behind, points[2] - plane[0])};
}

}  // namespace cdprep
