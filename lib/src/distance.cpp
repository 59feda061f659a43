// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "nearest_search.h"
#include "piece_contact.h"

namespace cdprep {
namespace {

bool is_one_empty(const Pair& pair) noexcept {
    return pair.a->triangle_count() == 0 || pair.b->triangle_count() == 0;
}

}  // namespace

std::optional<Distance> distance(const Pair& pair, Workspace& workspace,
                                 const DistanceOptions& options) noexcept {
    const format::FloatEnvironment environment;
    const Ask body = pair.options.body == Body::solid ? Ask::solid : Ask::nothing;
    require(*pair.a, *pair.b, Ask::distance | body | ask_of(pair.options.through));
    if (pair.options.through != Structure::pieces) {
        return distance_by<TriangleTrees>(pair, workspace, options);
    }
    if (is_one_empty(pair)) return std::nullopt;
    return distance_by<PieceTrees>(pair, workspace, options);
}

bool within(const Pair& pair, double tolerance, Workspace& workspace) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = *pair.a, &b = *pair.b;
    require(a, b, Ask::within | ask_of(pair.options.through));
    if (!(tolerance >= 0) || is_one_empty(pair)) return false;
    if (pair.options.through != Structure::pieces) {
        if (tolerance == 0) return any_contact(a, b, pair.placement, workspace, {}, pair.cache);
        return is_within_by<TriangleTrees>(a, b, pair.placement, tolerance, workspace, pair.cache);
    }
    if (tolerance == 0) {
        return any_contact_of_pieces(a, b, pair.placement, workspace, {}, pair.cache);
    }
    return is_within_by<PieceTrees>(a, b, pair.placement, tolerance, workspace, pair.cache,
                                    pair.front);
}

}  // namespace cdprep
