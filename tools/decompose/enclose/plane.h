// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/vectors.h"

namespace cdprep::convex {

using format::Double3;

struct Plane {
    Double3 normal;  ///< of length 1; 0 if there is no direction
    double offset;
};

[[nodiscard]] inline double height(const Plane& plane, const Double3& p) {
    return mesh::dot(plane.normal, p) - plane.offset;
}

/// Returns the plane of a triangle whose corners are not collinear. It is right up to rounding,
/// even if they nearly are: its height at a point at most D away from the corners is off by at most
/// 4e-14 D, and some roundings of the coordinates. Coordinates must be of usual size, as
/// SearchScale brings them. A triangle so small that its normal underflows has no direction.
[[nodiscard]] Plane exact_plane(const Double3& a, const Double3& b, const Double3& c);

}  // namespace cdprep::convex
