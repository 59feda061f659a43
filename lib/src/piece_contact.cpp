// SPDX-License-Identifier: MIT
#include "piece_contact.h"

#include <algorithm>

#include "box_placement.h"
#include "cached_search.h"
#include "gjk.h"

// A moved vertex is off its ideal place by a part of double_slack(), and so is a corner of a
// hull, whose coordinates are larger than the vertices' by no more than the hull's slack. The
// ideal places of vertices are in the hull of those of its corners: a pose is an affine map.

namespace cdprep {
namespace {

/// Most questions that pass after hulls that proved nothing: 2^this - 1.
constexpr std::uint32_t kMostHullFailures = 6;

/// How much less than the hulls the surfaces may be apart.
double hull_margin(const Model& a, const Model& b, const Placement& placement) noexcept {
    constexpr double kOfSlack = 0x1p-40;
    const double beyond = a.piece_node_hulls()[0].slack + b.piece_node_hulls()[0].slack;
    return 2 * double_slack(a, b, placement) + kOfSlack * beyond;
}

}  // namespace

// A hull has no neighbours to climb by: its reach is not asked for.
ConvexPoints hull_points(const format::PieceNodeHull& hull) noexcept {
    ConvexPoints points;
    const std::size_t blocks = (hull.count + format::kHullLanes - 1) / format::kHullLanes;
    points.blocks = std::span(hull.block).first(blocks);
    points.count = hull.count;
    return points;
}

bool hulls_prove_apart(const Model& a, const Model& b, const Placement& placement, double distance,
                       PieceCache& cache, QueryCounts* counts) noexcept {
    if (a.piece_node_hulls().empty() || b.piece_node_hulls().empty()) return false;
    if (cache.hull_wait > 0) {
        --cache.hull_wait;
        return false;
    }
    const double least = distance + hull_margin(a, b, placement);
    const ConvexPoints of_a = hull_points(a.piece_node_hulls()[0]);
    const ConvexPoints of_b = hull_points(b.piece_node_hulls()[0]);
    const TwoHulls hulls(of_a, of_b, placement);
    const GjkResult found =
        gjk(hulls.a, hulls.b, {.farther = least, .nearer = least}, &cache.hulls, counts);
    const bool apart = found.lower > least;
    cache.hull_failures = apart ? 0 : std::min(cache.hull_failures + 1, kMostHullFailures);
    cache.hull_wait = (1U << cache.hull_failures) - 1;
    return apart;
}

bool any_contact_of_pieces(const Model& a, const Model& b, const Placement& placement,
                           Workspace& workspace, const OverlapOptions& options,
                           PieceCache* cache) noexcept {
    if (cache == nullptr) {
        return find_contact_by<PieceTrees>(a, b, placement, workspace, options).has_value();
    }
    const std::size_t leaves_a = a.piece_leaves().size(), leaves_b = b.piece_leaves().size();
    if (leaves_a == 0 || leaves_b == 0) return false;
    PairCache& pair = cache->pair;
    if (still_touches(pair, a, b, placement, options, workspace.storage().counts)) return true;
    if (proven_gap(pair, a, b, placement) > 0) return false;
    const bool touched =
        (pair.holds & held_touch) != 0 && cache->leaf_a < leaves_a && cache->leaf_b < leaves_b;
    if (!touched && hulls_prove_apart(a, b, placement, 0, *cache, workspace.storage().counts)) {
        return false;
    }
    CachedSearch<PieceTrees> search(a, b, placement, workspace, options, pair);
    const bool hit =
        (touched && search.touches_again({cache->leaf_a, cache->leaf_b})) || search.walk();
    if (hit) {
        cache->leaf_a = search.last().a;
        cache->leaf_b = search.last().b;
    }
    return hit;
}

}  // namespace cdprep
