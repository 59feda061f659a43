// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "hull/convex_hull.h"

namespace cdprep::convex {

struct DropOptions {
    /// Points that stand out of the hull of the others by less are dropped; model units.
    double height = 0;
    /// The points that are left move out by less than this; model units. 0: nothing changes.
    double growth = 0;
};

struct DroppedPoints {
    ConvexHull hull;        ///< contains the given hull, exactly; `numbers` is empty if it grew
    double growth = 0;      ///< proved: no point is farther than this from the given hull
    std::size_t low = 0;    ///< points that still stand out by less than DropOptions::height
    std::size_t moved = 0;  ///< points that are not points of the given hull
};

/// Returns the height below which hull builders of physics engines ignore a point. PhysX 5 ignores
/// points within 0.0007 of half the sum of the box's sides (PxCookingParams::planeTolerance);
/// Rapier ignores points that are nearer. The result is larger by a margin for their floats. If
/// that half sum is smaller than `least_size`, it counts as that. To PhysX it is at least 1, in the
/// unit in which it cooks. PxTolerancesScale does not change this.
[[nodiscard]] double ignored_height(std::span<const Double3> points, double least_size = 0);

/// Returns a hull of fewer points around a hull of dimension 3. Each step replaces a low point and
/// a neighbour by one point in front of all planes through either. The hull then contains both,
/// and by the exact test of prove_points() all that it contained before. This is the edge collapse
/// of progressive hulls (Sander, Gu, Gortler, Hoppe and Snyder 2000). The low points that cannot be
/// replaced within the growth stay, and so do a few that would take most of it. Hulls of other
/// dimensions are returned unchanged.
[[nodiscard]] DroppedPoints drop_points(const ConvexHull& hull, const DropOptions& options);

}  // namespace cdprep::convex
