// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hull/convex_hull.h"

namespace cdprep::convex {

/// Returns a hull that contains this one, exactly, and has no corners nearer to each other than
/// `distance` (model units). Each group of near corners becomes one corner, pushed out by little
/// more than the group's extent. Cuts are rounded, so corners come in groups that differ in the
/// last digits. Readers with fewer digits turn those into facets without area. Returns the hull
/// unchanged if it has no groups or no such hull is found. Otherwise `numbers` is empty.
[[nodiscard]] ConvexHull merge_corners(ConvexHull hull, double distance);

}  // namespace cdprep::convex
