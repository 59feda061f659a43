// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "exact/triangle_contact.h"

namespace cdprep {

/// A half-line: origin + t direction, t >= 0.
struct HalfLine {
    Double3 origin;
    Double3 direction;  ///< not zero; decides all signs
    /// 2^exponent direction, about as long as the coordinates are large; the unit of lengths.
    /// Rounded where it is too small for a double.
    Double3 step;
    int exponent = 0;  ///< 0 if the step is not rounded; the direction then equals it
};

/// Returns the place where the half-line first meets the triangle, or nothing. The place is in
/// lengths of the step, and within 2^-40 of itself, or 2^-1074. The decision is exact, also for
/// edges, corners, coplanar half-lines and triangles without area.
[[nodiscard]] std::optional<double> ray_triangle(const HalfLine& ray, const Corners& t) noexcept;

}  // namespace cdprep
