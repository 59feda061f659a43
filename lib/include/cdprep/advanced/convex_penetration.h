// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/format/api.h"

namespace cdprep {

/// The penetration depth of two hulls: the length of the shortest translation of B after which they
/// only touch.
struct Penetration {
    double lower;       ///< every such translation is at least this long, model units; >= 0
    double upper;       ///< after B moves this far along `normal`, the hulls at most touch; proven
    Double3 normal;     ///< the direction of B's translation, of length 1 up to rounding
    Double3 witness_a;  ///< on A as moved, up to rounding: B touches A here after the translation
    Double3 witness_b;  ///< on B as moved, up to rounding: it touches A after the translation
};

/// Returns the penetration depth of two hulls that have a common point; touching counts. Returns
/// nothing if they have no common point, as convex_collide() decides exactly, or if one has no
/// points. So every contact has a depth. If the hulls only touch, or both lie in one plane, upper
/// is 0 up to rounding.
///
/// A - B is the Minkowski difference, and c its largest coordinate in magnitude. upper - lower is
/// at most 1e-12 upper + 1e-13 c. A larger permitted error replaces this limit. upper - lower
/// exceeds the limit only if the polytope described below would need more than 128 corners
/// (convex_penetration_laws_test). Finely rounded hulls of thousands of points can need that many
/// if they overlap deeply. Of `options`, only the permitted errors are read; the relative one is a
/// share of upper.
///
/// Uses the expanding polytope of van den Bergen (2001) with exact signs. The polytope lies within
/// A - B. Its corners are differences of a point of A and a point of B. The polytope grows where
/// its boundary is nearest to the origin. The distance from the origin to this boundary proves
/// `lower`. The reach of A - B along the normal proves `upper`. The farthest points of A along the
/// normal and of B in the opposite direction give this reach.
///
/// Takes ten to a hundred times as long as convex_distance(). Never allocates; uses 30 kB of stack.
[[nodiscard]] CDPREP_API std::optional<Penetration> convex_penetration(
    const ConvexPoints& a, const ConvexPoints& b, const Placement& placement,
    const DistanceOptions& options = {}, ConvexCache* cache = nullptr,
    QueryCounts* counts = nullptr) noexcept;

}  // namespace cdprep
