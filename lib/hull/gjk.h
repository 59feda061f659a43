// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include "cdprep/advanced/convex_distance.h"
#include "hull/moved_hull.h"
#include "hull/nearest_simplex.h"

namespace cdprep {

/// What ends a search.
struct GjkGoal {
    double relative_error = 0;
    double absolute_error = 0;
    /// A proof that the hulls are farther apart than this, model units.
    double farther = std::numeric_limits<double>::infinity();
    /// Two points that are at most so far apart, model units; negative: that is not asked.
    double nearer = -1;
};

/// What double knows for certain.
enum class GjkVerdict : std::uint8_t {
    apart,   ///< lower > 0
    meet,    ///< the simplex has the origin inside
    unsure,  ///< neither is proved
};

struct GjkResult {
    GjkVerdict verdict;
    double lower;  ///< the hulls are at least so far apart, model units; proved
    double upper;  ///< and at most so far; proved; infinite when they meet
    NearestSimplex simplex;
};

/// Searches in double. Where the verdict is `apart` and no goal ended the search before,
/// the bounds are as near each other as rounding lets them.
[[nodiscard]] GjkResult gjk(const MovedHull& a, const MovedHull& b, const GjkGoal& goal,
                            ConvexCache* cache, QueryCounts* counts) noexcept;

/// The distance of the simplex's nearest point from the origin, rounded up.
[[nodiscard]] double upper_bound(const NearestSimplex& simplex) noexcept;

}  // namespace cdprep
