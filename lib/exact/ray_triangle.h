// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "exact/triangle_contact.h"

namespace cdprep {

/// A half-line: origin + t direction, t >= 0.
struct HalfLine {
    Double3 origin;
    Double3 direction;  ///< not zero; signs are taken of this one
    /// 2^k direction, about as long as the coordinates are large; rounded where that is
    /// too small for a double. Lengths are measured in this one.
    Double3 step;
};

/// Returns where the half-line first meets the triangle, in lengths of the step and
/// rounded, or nothing. Whether it meets it is exact, edges, corners, coplanar
/// half-lines and triangles without area included.
[[nodiscard]] std::optional<double> ray_triangle(const HalfLine& ray, const Corners& t) noexcept;

}  // namespace cdprep
