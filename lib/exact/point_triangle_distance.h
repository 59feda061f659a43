// SPDX-License-Identifier: MIT
#pragma once

#include "exact/triangle_contact.h"

namespace cdprep {

/// Works for triangles without area and for all sizes from subnormals to
/// kMaxCoordinate. The interval is at most 32 u of the farthest corner's distance
/// wide, u = 2^-53, unless the point is much nearer than that: then up to 200 u,
/// and more for slivers.
[[nodiscard]] PointTriangleDistance point_triangle_distance(const Double3& q,
                                                            const Corners& t) noexcept;

}  // namespace cdprep
