// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "kernels/kernels.h"

namespace cdprep {

/// 2^exponent; without a call for exponents that give a normal number.
inline double two_to(int exponent) noexcept {
    constexpr int kBias = 1023;
    if (exponent <= -kBias || exponent > kBias) return std::ldexp(1.0, exponent);
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + kBias) << 52);
}

/// x * 2^exponent in two steps, of which none leaves the range when the result does
/// not.
inline double scaled(double x, int exponent) noexcept {
    return x * two_to(exponent / 2) * two_to(exponent - exponent / 2);
}

/// How the two hierarchies' boxes stand to each other, in float, with a slack
/// that makes every box test conservative for the vertices as the query moves
/// them: a pair that shares a point is never reported apart.
struct PlacedBoxes {
    kernels::BoxPlacement placement;
    bool apart;  ///< the root boxes are too far from each other to overlap

    /// The same map in double: pair = rotation * (scale_b * frame_b) + shift.
    std::array<double, 9> rotation;
    std::array<double, 3> shift;
    double scale_a;
    double scale_b;
    int exponent;  ///< of two: a pair unit is 2^-exponent model units
    /// How far vertices of the two models may be off, relative to each other,
    /// before any rounding to float. Pair units.
    double double_slack;
};

/// How far vertices of the two models may be off, relative to each other, model units.
[[nodiscard]] double double_slack(const Model& a, const Model& b,
                                  const Placement& placement) noexcept;

[[nodiscard]] PlacedBoxes place_boxes(const Model& a, const Model& b,
                                      const Placement& placement) noexcept;

/// Beyond, in pair units, squares of lengths would leave the range of float.
inline constexpr double kMostReach = 0x1p60;

/// Rounds a distance in pair units up; to infinity, which rules out nothing, where float
/// could not tell what is farther apart.
[[nodiscard]] float float_reach(double distance) noexcept;

/// What the places of two models tell of their triangles before anything is walked.
enum class Outlook : std::uint8_t {
    none,  ///< no two are within the tolerance
    some,  ///< nobody knows
    all,   ///< any two are
};

/// Of a tolerance in model units; neither model is empty.
[[nodiscard]] Outlook outlook(const PlacedBoxes& placed, double tolerance) noexcept;

/// How the boxes of a hierarchy with this frame stand to themselves.
[[nodiscard]] PlacedBoxes place_upon_itself(const Double3& frame_origin,
                                            std::int32_t frame_exponent) noexcept;

}  // namespace cdprep
