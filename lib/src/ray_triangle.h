// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "triangle_contact.h"

namespace cdprep {

/// A half-line by its origin and a second point on it.
struct HalfLine {
    Double3 origin;
    Double3 through;  ///< differs from the origin
};

/// Returns where the half-line first meets the triangle, in lengths of
/// through - origin and rounded, or nothing. Whether it meets it is exact, edges,
/// corners, coplanar half-lines and triangles without area included.
[[nodiscard]] std::optional<double> ray_triangle(const HalfLine& ray, const Corners& t) noexcept;

}  // namespace cdprep
