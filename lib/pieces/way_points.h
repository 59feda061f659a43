// SPDX-License-Identifier: MIT
#pragma once

#include "pieces/contact_side.h"

namespace cdprep {

/// A point on each of two pieces.
struct WayPoints {
    Double3 on_a;
    Double3 on_b;
};

/// Returns the points that touch when B has left A along a unit direction: of the corners of A
/// farthest along it, and those of B farthest against it, the points of their hulls that are
/// nearest to each other as seen along the direction. If several pairs are, returns one of them.
[[nodiscard]] WayPoints way_points(const ContactSide& a, const ContactSide& b,
                                   const Double3& direction) noexcept;

}  // namespace cdprep
