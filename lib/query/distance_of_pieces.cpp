// SPDX-License-Identifier: MIT
#include "query/distance_of_pieces.h"

#include <cassert>

#include "pieces/piece_contact.h"
#include "query/nearest_search.h"

namespace cdprep {

std::optional<Distance> distance_of_pieces(const Pair& pair, Workspace& workspace,
                                           const DistanceOptions& options) noexcept {
    const Model &a = pair.a, &b = pair.b;
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return std::nullopt;
    return distance_by<PieceTrees>(pair, workspace, options);
}

bool pieces_are_within(const Pair& pair, double tolerance, Workspace& workspace) noexcept {
    assert(tolerance >= 0);
    const Model &a = pair.a, &b = pair.b;
    if (tolerance == 0) {
        return any_contact_of_pieces(a, b, pair.placement, workspace, {}, pair.cache);
    }
    return is_within_by<PieceTrees>(a, b, pair.placement, tolerance, workspace, pair.cache,
                                    pair.front);
}

}  // namespace cdprep
