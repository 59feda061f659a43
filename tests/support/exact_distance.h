// SPDX-License-Identifier: MIT
#pragma once

#include "support/exact_rational.h"

#include "exact/triangle_contact.h"

namespace cdprep::test {

inline ExactRational square(double x) {
    return {ExactNumber(x) * ExactNumber(x), 1.0};
}

/// Returns the square of the distance from q to the closed triangle, without rounding.
/// Corners may be collinear or equal.
[[nodiscard]] ExactRational exact_squared_distance(const Double3& q, const Corners& corners);

/// Returns the square of the distance between two closed triangles, without rounding.
[[nodiscard]] ExactRational exact_squared_distance(const Corners& a, const Corners& b);

}  // namespace cdprep::test
