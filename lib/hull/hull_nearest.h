// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/convex_penetration.h"
#include "hull/exact_nearest.h"

namespace cdprep {

/// Where two hulls are nearest to each other, by the corners that say so.
struct HullNearest {
    bool meet;              ///< they have a common point
    DistanceBounds bounds;  ///< 0 and 0 when they meet
    /// The common point, or the two nearest ones, are sums of its corners' points. When they
    /// do not meet at most three, with weights above 0.
    NearestSimplex simplex;
};

/// What convex_distance() answers, and with the same errors. Neither hull is empty.
[[nodiscard]] std::optional<HullNearest> hull_nearest(const MovedHull& a, const MovedHull& b,
                                                      const DistanceOptions& options,
                                                      ConvexCache* cache,
                                                      QueryCounts* counts) noexcept;

/// What convex_penetration() answers of two hulls that meet, from the simplex that says so.
[[nodiscard]] Penetration hull_depth(const TwoHulls& hulls, const NearestSimplex& common,
                                     const DistanceOptions& options, QueryCounts* counts) noexcept;

/// Whether bounds are as near each other as is promised where no error is permitted; `size` is
/// that of a point of A - B, largest coordinate.
[[nodiscard]] inline bool is_near_enough(double lower, double upper, double size) noexcept {
    constexpr double kRelative = 1e-12;
    constexpr double kOfCoordinates = 1e-14;
    return upper - lower <= kRelative * upper + kOfCoordinates * size;
}

}  // namespace cdprep
