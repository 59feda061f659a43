// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hull/convex_hull.h"

namespace cdprep::convex {

/// Returns the convex hull without a search for inner points, as convex_hull() does for few
/// points.
[[nodiscard]] ConvexHull exact_hull(std::span<const Double3> points);

}  // namespace cdprep::convex
