// SPDX-License-Identifier: MIT
#pragma once

#include "exact/triangle_contact.h"

namespace cdprep {

/// Returns the distance of `q` from a triangle as a proved interval. Works for triangles without
/// area and for all sizes from subnormals to kMaxCoordinate. With u = 2^-53, the interval is at
/// most 32 u of the farthest corner's distance wide. If the point is much nearer than that corner,
/// it is up to 200 u wide, and more for slivers.
[[nodiscard]] PointTriangleDistance point_triangle_distance(const Double3& q,
                                                            const Corners& t) noexcept;

}  // namespace cdprep
