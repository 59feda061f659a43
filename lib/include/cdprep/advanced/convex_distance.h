// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "cdprep/advanced/convex_points.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/format/api.h"
#include "cdprep/pairs.h"

namespace cdprep {

// Queries about two convex hulls that read only their points. They use the method of Gilbert,
// Johnson and Keerthi (1988), GJK, in double. Every answer is proven; if double arithmetic proves
// nothing, the answer is computed without rounding.
//
// A query is about the hulls of the points as `placement` moves them (level E1 in GLOSSARY.md).
// transform_point() rounds each point once. Answers and proven bounds hold exactly for the rounded
// points. The hulls are solid: a hull inside another one touches it. A hull without points touches
// nothing.
//
// No query allocates. A step takes O(sqrt(n)) time for a hull of n points with
// ConvexPoints::neighbours, otherwise O(n). From a good start a few steps suffice. If hulls touch
// or nearly touch, within about 1e-15 of their coordinates, integer arithmetic decides in tens of
// microseconds.

/// The simplex with which the last GJK query about two hulls ended, as point numbers. The caller
/// owns it. The next query about the same two hulls begins there. This saves more time the less the
/// hulls have moved. Any content is allowed: it never changes whether hulls collide or are within a
/// tolerance. It may change the last digits of bounds, or change bounds by the errors that options
/// permit. Use one cache for each pair of hulls and thread. A new cache is all zero.
struct ConvexCache {
    std::uint32_t count = 0;           ///< used elements of `a` and `b`, at most 4
    std::array<std::uint32_t, 4> a{};  ///< points of A
    std::array<std::uint32_t, 4> b{};  ///< points of B
};

/// Returns whether two hulls have a common point; touching counts. Exact. `cache` and `counts` may
/// be null, also in the functions below.
[[nodiscard]] CDPREP_API bool convex_collide(const ConvexPoints& a, const ConvexPoints& b,
                                             const Placement& placement,
                                             ConvexCache* cache = nullptr,
                                             QueryCounts* counts = nullptr) noexcept;

/// The distance of two hulls, and points where it is attained.
struct ConvexDistance {
    double lower;       ///< the distance is at least this, model units
    double upper;       ///< the distance is at most this
    Double3 witness_a;  ///< on A as moved, up to rounding; nearest to B
    Double3 witness_b;  ///< on B as moved, up to rounding; at distance `upper` from witness_a
};

/// Returns the distance between two hulls. Returns nothing if a hull has no points, or if
/// options.max_distance is negative or NaN. Also returns nothing if the distance is proven to
/// exceed max_distance: `lower` of a result never exceeds it. If the hulls touch, both bounds are 0
/// and the witnesses are a common point. Otherwise, lower is above 0, except for gaps near the
/// smallest doubles. If faces or edges are parallel, many pairs of points are nearest; the
/// witnesses are one of them.
///
/// upper - lower is at most the error that `options` permits. It may exceed permitted errors below
/// 1e-14 of upper. Here, options.relative_error is a share of upper. Without permitted errors, the
/// limit is 1e-12 of upper plus 1e-14 of the size of A - B (convex_distance_laws_test). A - B is
/// the Minkowski difference. Its size is the largest difference between a point of A and a point of
/// B along a coordinate axis.
[[nodiscard]] CDPREP_API std::optional<ConvexDistance> convex_distance(
    const ConvexPoints& a, const ConvexPoints& b, const Placement& placement,
    const DistanceOptions& options = {}, ConvexCache* cache = nullptr,
    QueryCounts* counts = nullptr) noexcept;

/// Returns whether two hulls are at most `tolerance` apart; inclusive. A tolerance of 0 tests
/// whether they touch. Returns false for a negative tolerance or NaN, and if a hull has no points.
/// Exact: a tolerance that equals the distance gives true; the next smaller double gives false.
[[nodiscard]] CDPREP_API bool convex_within(const ConvexPoints& a, const ConvexPoints& b,
                                            const Placement& placement, double tolerance,
                                            ConvexCache* cache = nullptr,
                                            QueryCounts* counts = nullptr) noexcept;

}  // namespace cdprep
