// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/advanced/convex_distance.h"

namespace cdprep {

/// The penetration depth of two hulls: the length of the shortest translation of B after which they
/// only touch.
struct Penetration {
    double lower;       ///< no shorter translation does this, model units; >= 0
    double upper;       ///< this far along `normal`, they are apart or touch; proven
    Double3 normal;     ///< the direction of B's translation, of length 1 up to rounding
    Double3 witness_a;  ///< on A as moved, up to rounding: B touches it there afterwards
    Double3 witness_b;  ///< on B as moved, up to rounding: touches A afterwards
};

/// Returns the depth of two hulls that have a common point; touching counts. Returns nothing if
/// they have none, as convex_collide() decides exactly, or if one has no points. So no contact is
/// lost. If the hulls only touch, or both lie in one plane, upper is 0 up to rounding.
///
/// upper - lower is at most 1e-12 of upper plus 1e-13 of the largest coordinate, or as permitted.
/// It is larger only if the polytope would exceed 128 corners (convex_penetration_laws_test).
/// Finely rounded bodies of thousands of points that are deep in each other can need that many.
/// Reads the permitted errors of `options`; the relative one is a share of upper.
///
/// Uses the expanding polytope of van den Bergen (2001) with exact signs. The polytope lies within
/// A - B, and its corners are differences of points. It grows where its border is nearest to the
/// origin. The border proves lower, and the farthest points along a direction prove upper.
///
/// Takes ten to a hundred times as long as a distance. Never allocates; uses 30 kB of stack.
[[nodiscard]] std::optional<Penetration> convex_penetration(const ConvexPoints& a,
                                                            const ConvexPoints& b,
                                                            const Placement& placement,
                                                            const DistanceOptions& options = {},
                                                            ConvexCache* cache = nullptr,
                                                            QueryCounts* counts = nullptr) noexcept;

}  // namespace cdprep
