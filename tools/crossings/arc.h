// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "cdprep/format/geometry.h"

namespace cdprep::mesh {

using format::Double3;

/// Rounding moves a direction by less than this: it is 4 operations away from coordinates,
/// each exact to 2^-53 of a number no larger than 1.
inline constexpr double kDirectionMargin = 0x1p-46;

/// The direction from one point to another, of length 1. The points differ.
inline Double3 direction(const Double3& from, const Double3& to) {
    Double3 way = {to.x - from.x, to.y - from.y, to.z - from.z};
    double size = std::max({std::fabs(way.x), std::fabs(way.y), std::fabs(way.z)});
    if (!std::isfinite(size)) {
        way = {0.5 * to.x - 0.5 * from.x, 0.5 * to.y - 0.5 * from.y, 0.5 * to.z - 0.5 * from.z};
        size = std::max({std::fabs(way.x), std::fabs(way.y), std::fabs(way.z)});
    }
    way = {way.x / size, way.y / size, way.z / size};
    const double length = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
    return {way.x / length, way.y / length, way.z / length};
}

struct Ball {
    Double3 centre;
    double radius;
};

/// A triangle as seen from one of its corners is an arc of less than half a turn between two
/// directions. Returns the ball over the chord of that arc: it holds a multiple of the way
/// from the corner to any point of the triangle.
inline Ball arc_ball(const Double3& corner, const Double3& p, const Double3& q) {
    const Double3 a = direction(corner, p);
    const Double3 b = direction(corner, q);
    const double chord = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    return {{0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z)},
            0.5 * chord + kDirectionMargin};
}

}  // namespace cdprep::mesh
