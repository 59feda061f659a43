// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "hull/convex_hull.h"

namespace cdprep::convex {

inline constexpr std::uint32_t kFewestEnclosingVertices = 4;

struct EnclosingHull {
    ConvexHull hull;  ///< `numbers` is empty unless it is the exact one
    /// No point of it is farther than this from the exact hull; 0 if they are one. A
    /// proved upper bound of their Hausdorff distance, model units.
    double distance = 0;
};

/// Returns a hull of at most `max_vertices` points, at least kFewestEnclosingVertices, that
/// contains `exact`: every point of that is behind or on every facet, exactly, as the
/// coordinates are stored. It is `exact` itself where that has few enough points; a polygon
/// with more gets a solid around it.
///
/// Made of planes that touch the hull, each where the corner farthest out is cut off best.
/// Nothing when a coordinate would leave the range of double. O(V (V + n)) for V vertices
/// around n points.
[[nodiscard]] std::optional<EnclosingHull> enclosing_hull(const ConvexHull& exact,
                                                          std::uint32_t max_vertices);

}  // namespace cdprep::convex
