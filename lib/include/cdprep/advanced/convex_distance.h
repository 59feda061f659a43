// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "cdprep/advanced/convex_points.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/pairs.h"

namespace cdprep {

// Questions about two convex hulls, by their points alone: the method of Gilbert, Johnson
// and Keerthi (1988) in double, whose answers are proved before they are given, or found
// without rounding where double proves nothing.
//
// All are about the hulls of the points as `placement` moves them (level E1): each point
// is rounded once by transform_point(), and from then on nothing is. The hulls are solid: one
// inside the other touches it. A hull without points touches nothing.
//
// None allocates. Each step costs O(sqrt(n)) where the hull has neighbours, O(n) where it
// has not; from a good start there are a few steps. Where hulls touch or nearly do, within
// about 1e-15 of their coordinates, integers decide in tens of microseconds.

/// Where the last question about two hulls ended, owned by the caller: the next one about
/// the same two begins there, and costs less the less they have moved. Any content is
/// allowed and gives the same yes or no; bounds may differ in their last digits. One a
/// pair of hulls; threads need one each. All zero is a new cache.
struct ConvexCache {
    std::uint32_t count = 0;           ///< numbers below, at most 4
    std::array<std::uint32_t, 4> a{};  ///< points of A
    std::array<std::uint32_t, 4> b{};  ///< points of B
};

/// Returns whether two hulls have a common point; touching counts. Exact. `cache` and
/// `counts` may be null, here and below.
[[nodiscard]] bool convex_collide(const ConvexPoints& a, const ConvexPoints& b,
                                  const Placement& placement, ConvexCache* cache = nullptr,
                                  QueryCounts* counts = nullptr) noexcept;

/// The distance of two hulls, and where it is taken.
struct ConvexDistance {
    double lower;       ///< the distance is at least this, model units
    double upper;       ///< and at most this
    Double3 witness_a;  ///< on A as moved, up to rounding; nearest to B
    Double3 witness_b;  ///< on B as moved, up to rounding; `upper` from witness_a
};

/// Returns how far two hulls are apart, or nothing when that is more than `max_distance`
/// or one has no points. Both bounds are 0 when the hulls touch, with a common point as
/// witness, and lower is above 0 when they do not, but for gaps near the smallest doubles.
///
/// upper - lower is at most what is permitted, but for relative errors, which are shares of upper
/// here, below 1e-14. Where
/// nothing is, it is at most 1e-12 of upper plus 1e-14 of the size of A - B, that is how
/// far any point of A is from any of B along an axis (convex_distance_laws_test).
/// Where faces or edges are parallel there are many nearest pairs: one of them answers.
[[nodiscard]] std::optional<ConvexDistance> convex_distance(const ConvexPoints& a,
                                                            const ConvexPoints& b,
                                                            const Placement& placement,
                                                            const DistanceOptions& options = {},
                                                            ConvexCache* cache = nullptr,
                                                            QueryCounts* counts = nullptr) noexcept;

/// Returns whether two hulls are at most `tolerance` apart: the tolerance belongs to it,
/// and 0 asks whether they touch. False for a negative tolerance or NaN. Exact: a distance
/// equal to the tolerance to the last bit is within it, and one step less is not.
[[nodiscard]] bool convex_within(const ConvexPoints& a, const ConvexPoints& b,
                                 const Placement& placement, double tolerance,
                                 ConvexCache* cache = nullptr,
                                 QueryCounts* counts = nullptr) noexcept;

}  // namespace cdprep
