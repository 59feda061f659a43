// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/convex_penetration.h"
#include "hull/exact_nearest.h"

namespace cdprep {

/// The nearest points of two hulls, with the corners that define them.
struct HullNearest {
    bool meet;              ///< they have a common point
    DistanceBounds bounds;  ///< 0 and 0 when they meet
    /// The common point, or the two nearest points, are weighted sums of its corners' points. If
    /// the hulls do not meet, there are at most three corners, with weights above 0.
    NearestSimplex simplex;
};

/// Returns the result of convex_distance(), with the same errors. Neither hull is empty.
[[nodiscard]] std::optional<HullNearest> hull_nearest(const MovedHull& a, const MovedHull& b,
                                                      const DistanceOptions& options,
                                                      ConvexCache* cache,
                                                      QueryCounts* counts) noexcept;

/// Returns the result of convex_penetration() for two hulls that meet. `common` is the simplex that
/// proves it.
[[nodiscard]] Penetration hull_depth(const TwoHulls& hulls, const NearestSimplex& common,
                                     const DistanceOptions& options, QueryCounts* counts) noexcept;

/// Returns whether the bounds are as close to each other as promised where no error is permitted.
/// `size` is the largest coordinate of a point of A - B.
[[nodiscard]] inline bool is_near_enough(double lower, double upper, double size) noexcept {
    constexpr double kRelative = 1e-12;       // as convex_distance.h promises
    constexpr double kOfCoordinates = 1e-14;  // the same
    return upper - lower <= kRelative * upper + kOfCoordinates * size;
}

}  // namespace cdprep
