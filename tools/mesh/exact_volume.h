// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cdprep/format/geometry.h"

namespace cdprep::mesh {

/// Six times the volume under triangles, added up exactly: the determinants of their
/// corners, products of three doubles, as integers in units of 2^-3222. Of a balanced
/// surface it is six times its volume. Any finite coordinates, up to 2^31 triangles. Never
/// allocates; a microsecond a triangle.
class ExactVolume {
public:
    void add(const format::Double3& a, const format::Double3& b, const format::Double3& c);

    /// -1, 0 or 1.
    [[nodiscard]] int sign() const;

    /// The volume (a sixth of the sum), rounded; the largest double where it is beyond.
    [[nodiscard]] double volume() const;

private:
    // Bits: 3 * 2098 of products of three, 34 of their number.
    static constexpr std::size_t kLimbs = 100;
    using Limbs = std::array<std::uint64_t, kLimbs>;

    void add_product(double x, double y, double z, bool subtract);
    static void add_at(Limbs& sum, std::size_t limb, std::uint64_t value);
    [[nodiscard]] static Limbs difference(const Limbs& larger, const Limbs& smaller);
    static double as_double(const Limbs& sum);

    Limbs positive_{};
    Limbs negative_{};
};

}  // namespace cdprep::mesh
