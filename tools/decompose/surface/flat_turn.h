// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/exact/predicates.h"

namespace cdprep::convex {

/// Returns the turn of a, b, c as seen along an axis: -1, 0 or 1. Exact.
[[nodiscard]] inline int flat_turn(int axis, const Double3& a, const Double3& b, const Double3& c) {
    const auto seen = [axis](const Double3& p) {
        return axis == 0 ? Double2{p.y, p.z} : axis == 1 ? Double2{p.z, p.x} : Double2{p.x, p.y};
    };
    return exact::orient2d(seen(a), seen(b), seen(c));
}

/// Returns the first axis along which the three points are seen to turn. The projection of their
/// plane along it is one-to-one. Returns 3 if they lie on a line.
[[nodiscard]] inline int axis_of_turn(const Double3& a, const Double3& b, const Double3& c) {
    int axis = 0;
    while (axis < 3 && flat_turn(axis, a, b, c) == 0) ++axis;
    return axis;
}

}  // namespace cdprep::convex
