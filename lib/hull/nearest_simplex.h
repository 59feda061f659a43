// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "exact/vectors.h"

namespace cdprep {

/// A point of A minus a point of B: a corner of A - B, the set of all differences. The two hulls
/// have a common point exactly when A - B holds the origin.
struct Difference {
    std::uint32_t a;
    std::uint32_t b;
    Double3 at_a;  ///< after moving
    Double3 at_b;
    Double3 at;  ///< at_a - at_b, each coordinate rounded once
};

/// Up to four corners, and the point of their hull that is nearest to the origin.
struct NearestSimplex {
    std::array<Difference, 4> corner;
    std::array<double, 4> weight{};  ///< >= 0, sum 1 up to rounding
    std::size_t count = 0;

    [[nodiscard]] bool has(std::uint32_t a, std::uint32_t b) const noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            if (corner[i].a == a && corner[i].b == b) return true;
        }
        return false;
    }
};

/// Drops the corners that the nearest point does not depend on, and sets the weights. Keeps all
/// four when the origin is inside, up to rounding. (The signed volumes of Montanari, Petrinic and
/// Barbieri 2017. Where their signs leave a choice, or are all 0, the nearest of the candidate
/// faces is taken.)
void keep_nearest(NearestSimplex& simplex) noexcept;

/// Returns true only when four corners certainly hold the origin strictly inside.
[[nodiscard]] bool certainly_encloses_origin(const NearestSimplex& simplex) noexcept;

/// Returns the weighted sum of the corners' points: of A, of B or of A - B.
[[nodiscard]] Double3 weighted_sum(const NearestSimplex& simplex,
                                   Double3 Difference::*side) noexcept;

/// Returns the nearest point, by the weights.
[[nodiscard]] inline Double3 weighted_point(const NearestSimplex& simplex) noexcept {
    return weighted_sum(simplex, &Difference::at);
}

/// Returns the direction from the origin to the nearest point of at most three corners, of any
/// length. More exact than weighted_point(). The error of that point is about 1e-16 of the corners'
/// distance from the origin, however near the point is. Returns 0, 0, 0 when the corners have no
/// area or length.
[[nodiscard]] Double3 nearest_direction(const NearestSimplex& simplex) noexcept;

}  // namespace cdprep
