// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/geometry.h"

namespace cdprep {

using format::Double3;

/// A point of a coordinate plane.
struct Double2 {
    double x, y;
};

/// Returns the sign, -1, 0 or 1, of det[a-c, b-c]: positive when a, b, c turn
/// counter-clockwise. Exact for all finite inputs up to kMaxCoordinate and all
/// subnormals.
[[nodiscard]] int orient2d(const Double2& a, const Double2& b, const Double2& c) noexcept;

/// Returns the sign, -1, 0 or 1, of det[a-d, b-d, c-d]. Exact for all finite
/// inputs up to kMaxCoordinate, subnormals included. Never allocates.
///
/// A semi-static filter decides most calls in about 20 operations; then exact
/// differences with expansions; then full expansions with tails.
[[nodiscard]] int orient3d(const Double3& a, const Double3& b, const Double3& c,
                           const Double3& d) noexcept;

}  // namespace cdprep
