// SPDX-License-Identifier: MIT
#pragma once

#include "pieces/contact_side.h"

namespace cdprep {

/// A point on each of two pieces.
struct WayPoints {
    Double3 on_a;
    Double3 on_b;
};

/// Returns the points that touch when B has left A along a unit direction. They lie in the hulls
/// of A's corners farthest along it and of B's farthest against it. As seen along the direction,
/// they are nearest to each other. If several pairs are, returns one of them.
[[nodiscard]] WayPoints way_points(const ContactSide& a, const ContactSide& b,
                                   const Double3& direction) noexcept;

}  // namespace cdprep
