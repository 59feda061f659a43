// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hull/convex_hull.h"

namespace cdprep::convex {

/// Returns a hull that holds this one, exactly, without corners nearer to each other than
/// `distance`, model units: each such group becomes one corner, pushed out by little more
/// than the group's own extent. Cuts are rounded, so that corners come in groups that differ
/// in the last digits; readers with fewer digits make facets without area of those. The hull
/// as it is where there are no groups, or none can be had. `numbers` is empty then.
[[nodiscard]] ConvexHull merge_corners(ConvexHull hull, double distance);

}  // namespace cdprep::convex
