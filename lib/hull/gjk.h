// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include "cdprep/advanced/convex_distance.h"
#include "hull/moved_hull.h"
#include "hull/nearest_simplex.h"

namespace cdprep {

/// The conditions that end a search.
struct GjkGoal {
    double relative_error = 0;
    double absolute_error = 0;
    /// Ends on a proof that the hulls are farther apart than this, model units.
    double farther = std::numeric_limits<double>::infinity();
    /// Ends at two points at most this far apart, model units; negative: never.
    double nearer = -1;
};

/// The verdict that double arithmetic proves.
enum class GjkVerdict : std::uint8_t {
    apart,   ///< lower > 0
    meet,    ///< the simplex has the origin inside
    unsure,  ///< neither is proved
};

struct GjkResult {
    GjkVerdict verdict;
    double lower;  ///< proven lower bound of the distance, model units
    double upper;  ///< proven upper bound; infinite when they meet
    NearestSimplex simplex;
};

/// Searches in double. If the verdict is `apart` and no goal ended the search earlier, the bounds
/// are as close to each other as rounding permits.
[[nodiscard]] GjkResult gjk(const MovedHull& a, const MovedHull& b, const GjkGoal& goal,
                            ConvexCache* cache, QueryCounts* counts) noexcept;

/// Returns the distance of the simplex's nearest point from the origin, rounded up.
[[nodiscard]] double upper_bound(const NearestSimplex& simplex) noexcept;

}  // namespace cdprep
