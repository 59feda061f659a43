// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "cdprep/format/geometry.h"

namespace cdprep {

/// Returns the length of a finite vector, rounded a few times. It overflows only where the length
/// does. Replaces std::hypot() of three numbers, which is a template: the linker may keep a copy
/// that a caller compiled with -ffast-math.
inline double length_of(double x, double y, double z) noexcept {
    x = std::fabs(x);
    y = std::fabs(y);
    z = std::fabs(z);
    const double most = x < y ? (y < z ? z : y) : (x < z ? z : x);
    if (most == 0) return 0;
    return most *
           std::sqrt((x / most) * (x / most) + (y / most) * (y / most) + (z / most) * (z / most));
}
inline double length_of(const format::Double3& v) noexcept {
    return length_of(v.x, v.y, v.z);
}

}  // namespace cdprep
