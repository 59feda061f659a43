// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cdprep/advanced/query_counts.h"
#include "hull/moved_hull.h"
#include "hull/nearest_simplex.h"

namespace cdprep {

/// When a search in integers may end.
enum class ExactGoal : std::uint8_t {
    verdict,  ///< as soon as it is known whether the hulls meet
    nearest,  ///< not before the nearest corners are known
};

/// What is known of two hulls without rounding.
struct ExactNearest {
    bool meet;  ///< they have a common point
    /// When they meet, at most four whose hull holds the origin. When they do not and the
    /// goal was the nearest, at most three such that the nearest point of their hull is
    /// that of all of A - B; else at least one.
    std::array<Difference, 4> corner;
    std::size_t count;
};

/// Answers without rounding, from up to four corners of A - B, at least one: the nearer
/// to the origin, the fewer steps. In integers: tens of microseconds for a few steps on
/// everyday numbers, and one look at every point a step. Never allocates. `counts` may be null.
[[nodiscard]] ExactNearest exact_nearest(const MovedHull& a, const MovedHull& b,
                                         const NearestSimplex& from, ExactGoal goal,
                                         QueryCounts* counts) noexcept;

/// Bounds of a distance, model units.
struct DistanceBounds {
    double lower;
    double upper;
};

/// Returns the distance of hulls that do not meet, within 2^-48 of itself, or a step of
/// the smallest doubles.
[[nodiscard]] DistanceBounds bounds_of(const ExactNearest& nearest) noexcept;

/// Returns whether hulls that do not meet are at most `tolerance` apart: finite, >= 0.
[[nodiscard]] bool is_within(const ExactNearest& nearest, double tolerance) noexcept;

/// Returns up to four corners' point nearest to the origin, and the corners it needs: as
/// keep_nearest(), but chosen without rounding, and each weight within 2^-50 of itself.
/// For slivers, whose weights in double may be anything.
[[nodiscard]] NearestSimplex exactly_weighted(const Difference* corner, std::size_t count) noexcept;

}  // namespace cdprep
