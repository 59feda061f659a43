// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/advanced/convex_points.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/format/api.h"
#include "cdprep/format/pieces.h"
#include "cdprep/pose.h"

namespace cdprep {

/// The kind of a feature of a surface.
enum class FeatureKind : std::uint8_t { vertex, edge, face };

/// A convex hull with its surface.
struct FeatureHull {
    ConvexPoints points;  ///< corners only
    /// The closed surface of the hull; empty if the hull is a segment or a point.
    std::span<const format::PieceFacet> facets;
    std::span<const format::PieceAdjacency> adjacency;  ///< per facet
};

/// A feature of a hull's surface. A face is a maximal set of coplanar facets. An edge separates two
/// faces, or is a whole segment.
struct HullFeature {
    FeatureKind kind;
    /// For a vertex, the number of its point. For a face, the number of its first facet. For an
    /// edge from corner i of a facet to the next corner, 3 * facet + i. Two facets share each edge;
    /// the lower of the two numbers counts. For the edge of a segment, 0.
    std::uint32_t number;
    friend bool operator==(const HullFeature&, const HullFeature&) = default;
};

/// The features at which two hulls are nearest to each other.
struct ClosestFeatures {
    HullFeature a;  ///< contains witness_a, up to rounding
    HullFeature b;
    double lower;  ///< the distance is at least this, model units; proven
    double upper;  ///< the distance is at most this; proven
    Double3 witness_a;
    Double3 witness_b;
    /// True if parallel features are nearest: two edges, an edge and a face, or two faces. `a` or
    /// `b` may then name a vertex or an edge of such a feature. Other pairs of points may be
    /// equally near. It may be wrong for models larger than 1e50 or smaller than 1e-50.
    bool parallel;
};

/// The features at which the last query about two hulls ended, owned by the caller like a
/// ConvexCache. The next query begins there. Any content is allowed; a new cache is all zero.
struct FeatureCache {
    bool is_set = false;
    std::array<FeatureKind, 2> kind{};    ///< of A and B
    std::array<std::uint32_t, 2> edge{};  ///< the place of the feature: 3 * facet + corner
};

/// Returns the features of two hulls that are nearest to each other. Returns nothing if the hulls
/// have a common point, as convex_collide() decides exactly, or if one has no points.
///
/// The bounds are as tight as those of convex_distance() with default options. If several pairs of
/// features are nearest, the result is one of them and may depend on the cache. If a nearest point
/// lies on the border of two features, up to rounding, the result may name either.
///
/// With a cache, uses the method of Lin and Canny (1991). It walks from feature to neighbouring
/// feature while the distance decreases. This takes O(1) time if the hulls have moved little. The
/// farthest points of both hulls along the gap then prove the distance. GJK (convex_distance.h)
/// computes the result if there is no cache, the cache is new, or a hull has no facets. It also
/// does so if the walk or its proof fails. The proof fails if the hulls touch. Never allocates.
[[nodiscard]] CDPREP_API std::optional<ClosestFeatures> closest_features(
    const FeatureHull& a, const FeatureHull& b, const Placement& placement,
    FeatureCache* cache = nullptr, QueryCounts* counts = nullptr) noexcept;

}  // namespace cdprep
