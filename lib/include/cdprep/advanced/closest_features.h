// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/advanced/convex_points.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/format/pieces.h"
#include "cdprep/pose.h"

namespace cdprep {

/// A part of a surface.
enum class FeatureKind : std::uint8_t { vertex, edge, face };

/// A convex hull with its surface.
struct FeatureHull {
    ConvexPoints points;  ///< all of them corners
    /// A closed surface over the points; empty for a segment or a point alone.
    std::span<const format::PieceFacet> facets;
    std::span<const format::PieceAdjacency> adjacency;  ///< per facet
};

/// A part of a hull's surface. Faces are maximal coplanar ones, edges are between two of them.
struct HullFeature {
    FeatureKind kind;
    /// The point; of an edge 3 * facet + i, the lower of both that run along it, from corner i of
    /// the facet to the next, 0 of a segment; of a face its first facet.
    std::uint32_t number;
    friend bool operator==(const HullFeature&, const HullFeature&) = default;
};

/// Where two hulls are nearest to each other.
struct ClosestFeatures {
    HullFeature a;  ///< has witness_a inside, up to rounding
    HullFeature b;
    double lower;  ///< the distance is at least this, model units; proved
    double upper;  ///< and at most this; proved
    Double3 witness_a;
    Double3 witness_b;
    /// The parts of A and B that are nearest have parallel edges, or an edge and a face, or two
    /// faces: other pairs of points may be as near.
    bool parallel;
};

/// Where the last question about two hulls ended, owned by the caller, as ConvexCache: the next
/// one begins there. Any content is allowed; all zero is a new one.
struct FeatureCache {
    bool is_set = false;
    std::array<FeatureKind, 2> kind{};    ///< of A and B
    std::array<std::uint32_t, 2> edge{};  ///< where it is: 3 * facet + corner
};

/// Returns the features of two hulls that are nearest to each other, or nothing when the hulls
/// have a common point (exactly as convex_collide() says) or one has no points.
///
/// Distances are as narrow as those of convex_distance(). Where many pairs are nearest, one
/// answers, another cache may lead to another; and where the nearest point is within rounding of
/// an edge or a corner, either feature may be said to hold it.
///
/// From a cache, by the method of Lin and Canny (1991): from feature to neighbouring feature
/// while that is nearer, O(1) where little has moved. What that finds is proved by the corners
/// that are farthest along the gap; where it goes in circles, or the hulls touch, and without a
/// cache, GJK answers. Never allocates.
[[nodiscard]] std::optional<ClosestFeatures> closest_features(
    const FeatureHull& a, const FeatureHull& b, const Placement& placement,
    FeatureCache* cache = nullptr, QueryCounts* counts = nullptr) noexcept;

}  // namespace cdprep
