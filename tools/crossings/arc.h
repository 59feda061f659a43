// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "cdprep/format/geometry.h"

namespace cdprep::mesh {

using format::Double3;

/// The bound on the rounding error of a direction. It takes 4 operations from the coordinates,
/// each exact to 2^-53 of a number no larger than 1.
inline constexpr double kDirectionMargin = 0x1p-46;

/// Returns the direction from one point to another, of length 1. The points must differ.
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

/// Returns a ball that bounds a triangle as seen from one of its corners. Seen so, the triangle
/// is an arc of less than half a turn between two directions. The ball is the one over the chord
/// of that arc. For any point of the triangle, it holds a multiple of the vector from the corner
/// to the point.
inline Ball arc_ball(const Double3& corner, const Double3& p, const Double3& q) {
    const Double3 a = direction(corner, p);
    const Double3 b = direction(corner, q);
    const double chord = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    return {{0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z)},
            0.5 * chord + kDirectionMargin};
}

}  // namespace cdprep::mesh
