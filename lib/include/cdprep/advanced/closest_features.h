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

/// The kind of a feature of a surface.
enum class FeatureKind : std::uint8_t { vertex, edge, face };

/// A convex hull with its surface.
struct FeatureHull {
    ConvexPoints points;  ///< corners only
    /// A closed surface over the points; empty for a segment or a point alone.
    std::span<const format::PieceFacet> facets;
    std::span<const format::PieceAdjacency> adjacency;  ///< per facet
};

/// A feature of a hull's surface. Faces are maximal and coplanar; an edge separates two faces.
struct HullFeature {
    FeatureKind kind;
    /// The number of the point of a vertex, or of the first facet of a face. An edge from corner i
    /// of a facet to the next has 3 * facet + i, the lower of two such numbers. A segment has 0.
    std::uint32_t number;
    friend bool operator==(const HullFeature&, const HullFeature&) = default;
};

/// The features at which two hulls are nearest to each other.
struct ClosestFeatures {
    HullFeature a;  ///< contains witness_a, up to rounding
    HullFeature b;
    double lower;  ///< the distance is at least this, model units; proven
    double upper;  ///< and at most this; proven
    Double3 witness_a;
    Double3 witness_b;
    /// The nearest features of A and B have parallel edges, are an edge and a face, or are two
    /// faces. Other pairs of points may be equally near.
    bool parallel;
};

/// The features at which the last query about two hulls ended, owned by the caller like a
/// ConvexCache. The next query begins there. Any content is allowed; all zero is a new cache.
struct FeatureCache {
    bool is_set = false;
    std::array<FeatureKind, 2> kind{};    ///< of A and B
    std::array<std::uint32_t, 2> edge{};  ///< the place of the feature: 3 * facet + corner
};

/// Returns the features of two hulls that are nearest to each other. Returns nothing if the hulls
/// have a common point, as convex_collide() decides exactly, or if one has no points.
///
/// Distances are as narrow as those of convex_distance(). If several pairs are nearest, the result
/// is one of them, and another cache may give another. If the nearest point is within rounding of
/// an edge or a corner, the result may be either feature.
///
/// With a cache, uses the method of Lin and Canny (1991). It walks from a feature to a neighbouring
/// one while that is nearer, in O(1) if little has moved. The points farthest along the gap then
/// prove the distance. GJK answers without a cache, or if the walk does not end or the hulls touch.
/// Never allocates.
[[nodiscard]] std::optional<ClosestFeatures> closest_features(
    const FeatureHull& a, const FeatureHull& b, const Placement& placement,
    FeatureCache* cache = nullptr, QueryCounts* counts = nullptr) noexcept;

}  // namespace cdprep
