// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/advanced/convex_distance.h"

namespace cdprep {

/// How deep two hulls are in each other: the length of the shortest way that takes B out
/// of A, so that they only touch.
struct Penetration {
    double lower;       ///< no shorter way does, model units; >= 0
    double upper;       ///< so far along `normal` they are apart or touch, for certain
    Double3 normal;     ///< the way that B goes, of length 1 up to rounding
    Double3 witness_a;  ///< on A as moved, up to rounding: where B then touches it
    Double3 witness_b;  ///< on B as moved, up to rounding: what of B then touches A
};

/// Returns the depth of two hulls that have a common point, touching included, and nothing
/// when they have none or one has no points: exactly as convex_collide() says. So a
/// contact is never dropped; where the hulls only touch, or both lie in one plane, upper
/// is 0 up to rounding.
///
/// The expanding polytope of van den Bergen (2001) with exact signs: a polytope within
/// A - B whose corners are differences of points grows where its border is nearest to the
/// origin. Its border proves lower, the farthest points along a direction prove upper. At
/// most 1e-12 of upper plus 1e-13 of the largest coordinate apart, or what is permitted;
/// wider only where the polytope would need more than 128 corners, as between finely
/// rounded bodies of thousands of points that are deep in each other
/// (convex_penetration_laws_test).
///
/// Reads the permitted errors of `options`, the relative one as a share of upper.
/// About as expensive as ten to a hundred distances. Never allocates; 30 kB of stack.
[[nodiscard]] std::optional<Penetration> convex_penetration(const ConvexPoints& a,
                                                            const ConvexPoints& b,
                                                            const Placement& placement,
                                                            const DistanceOptions& options = {},
                                                            ConvexCache* cache = nullptr,
                                                            QueryCounts* counts = nullptr) noexcept;

}  // namespace cdprep
