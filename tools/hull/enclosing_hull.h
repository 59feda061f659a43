// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "hull/convex_hull.h"

namespace cdprep::convex {

inline constexpr std::uint32_t kFewestEnclosingVertices = 4;

struct EnclosingHull {
    ConvexHull hull;  ///< `numbers` is empty unless it is the exact hull
    /// A proved upper bound on the Hausdorff distance from the exact hull, in model units. No
    /// point is farther from it. 0 if the hulls are equal.
    double distance = 0;
};

/// Returns a hull of at most `max_vertices` points that contains `exact`. Every point of `exact`
/// is behind or on every facet, exactly, for the stored coordinates. Returns `exact` itself if
/// that has few enough points. A polygon with more points gets a solid around it. Returns
/// nothing if a coordinate would leave the range of double.
///
/// `max_vertices` must be at least kFewestEnclosingVertices. The facets are planes that touch
/// the hull; each one is chosen to cut off the farthest corner best. O(V (V + n)) for V vertices
/// around n points.
[[nodiscard]] std::optional<EnclosingHull> enclosing_hull(const ConvexHull& exact,
                                                          std::uint32_t max_vertices);

}  // namespace cdprep::convex
