// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hull/convex_hull.h"

namespace cdprep::convex {

/// convex_hull() of all points, with nothing in front of it: what it is for few points.
[[nodiscard]] ConvexHull exact_hull(std::span<const Double3> points);

}  // namespace cdprep::convex
