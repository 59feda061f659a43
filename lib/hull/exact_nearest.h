// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cdprep/advanced/query_counts.h"
#include "hull/moved_hull.h"
#include "hull/nearest_simplex.h"

namespace cdprep {

/// The point at which a search in integers may end.
enum class ExactGoal : std::uint8_t {
    verdict,  ///< as soon as it is known whether the hulls meet
    nearest,  ///< not before the nearest corners are known
};

/// A result about two hulls, computed without rounding.
struct ExactNearest {
    bool meet;  ///< they have a common point
    /// If the hulls meet: at most four corners whose hull holds the origin. If they do not meet and
    /// the goal was `nearest`: at most three corners. Their hull and all of A - B have the same
    /// point nearest to the origin. Otherwise at least one corner.
    std::array<Difference, 4> corner;
    std::size_t count;
};

/// Computes the result without rounding, from one to four corners of A - B. Corners nearer to the
/// origin save steps. Works in integers: a few steps on everyday numbers take tens of microseconds.
/// Each step tests every point. Never allocates. `counts` may be null.
[[nodiscard]] ExactNearest exact_nearest(const MovedHull& a, const MovedHull& b,
                                         const NearestSimplex& from, ExactGoal goal,
                                         QueryCounts* counts) noexcept;

/// Bounds of a distance, model units.
struct DistanceBounds {
    double lower;
    double upper;
};

/// Returns the distance of hulls that do not meet, within 2^-48 of itself or a step of the smallest
/// doubles.
[[nodiscard]] DistanceBounds bounds_of(const ExactNearest& nearest) noexcept;

/// Returns whether hulls that do not meet are at most `tolerance` apart. `tolerance` is finite and
/// >= 0.
[[nodiscard]] bool is_within(const ExactNearest& nearest, double tolerance) noexcept;

/// Returns the point nearest to the origin in the hull of up to four corners, and the corners that
/// it depends on. Like keep_nearest(), but the choice is exact and each weight is within 2^-50 of
/// itself. Use it for slivers, whose weights in double may be anything.
[[nodiscard]] NearestSimplex exactly_weighted(const Difference* corner, std::size_t count) noexcept;

}  // namespace cdprep
