// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "exact/vectors.h"

namespace cdprep {

/// A point of A less a point of B: of the corners of A - B, the set of all differences.
/// The two hulls have a common point exactly when A - B holds the origin.
struct Difference {
    std::uint32_t a;
    std::uint32_t b;
    Double3 at_a;  ///< after moving
    Double3 at_b;
    Double3 at;  ///< at_a - at_b, each coordinate rounded once
};

/// At most four corners, and the point of their hull that is nearest to the origin.
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

/// Drops the corners that the nearest point does not need and sets the weights. All four
/// stay when the origin is inside, as far as double can tell. (The signed volumes of
/// Montanari, Petrinic and Barbieri 2017; where their signs leave a choice, or are all 0,
/// the nearest of the faces in question is taken.)
void keep_nearest(NearestSimplex& simplex) noexcept;

/// True when four corners have the origin strictly inside for certain.
[[nodiscard]] bool certainly_encloses_origin(const NearestSimplex& simplex) noexcept;

/// Returns the sum of the corners' points, of A, of B or of A - B, with their weights.
[[nodiscard]] Double3 weighted_sum(const NearestSimplex& simplex,
                                   Double3 Difference::*side) noexcept;

/// Returns the nearest point by the weights.
[[nodiscard]] inline Double3 weighted_point(const NearestSimplex& simplex) noexcept {
    return weighted_sum(simplex, &Difference::at);
}

/// Returns the direction from the origin to the nearest point of at most three corners,
/// of any length: more exact than weighted_point(), which is off by about 1e-16 of the
/// corners' distance from the origin however near that point is. 0, 0, 0 when the corners
/// have no area or length.
[[nodiscard]] Double3 nearest_direction(const NearestSimplex& simplex) noexcept;

}  // namespace cdprep
