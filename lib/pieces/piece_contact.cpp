// SPDX-License-Identifier: MIT
#include "pieces/piece_contact.h"

#include <cassert>

#include "walk/contact_pairs.h"

namespace cdprep {

// A hull has no neighbours to climb, so its reach is never read.
ConvexPoints hull_points(const format::PieceNodeHull& hull) noexcept {
    ConvexPoints points;
    const std::size_t blocks = (hull.count + format::kHullLanes - 1) / format::kHullLanes;
    assert(hull.count > 0 && blocks <= hull.block.size());
    points.blocks = std::span(hull.block).first(blocks);
    points.count = hull.count;
    return points;
}

// With a cache, boxes around triangles are used. From a pair of triangles that touched, they lead
// to others fastest. Where nothing touches, they are walked equally fast.
bool any_contact_of_pieces(const Model& a, const Model& b, const Placement& placement,
                           Workspace& workspace, const PairOptions& options,
                           PairCache* cache) noexcept {
    if (cache == nullptr) {
        return find_contact_by<PieceTrees>(a, b, placement, workspace, options).has_value();
    }
    if (a.pieces().leaves.empty() || b.pieces().leaves.empty()) return false;
    return any_contact(a, b, placement, workspace, options, cache);
}

}  // namespace cdprep
