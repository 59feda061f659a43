// SPDX-License-Identifier: MIT
#include "cdprep/distance_through.h"

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "nearest_search.h"
#include "piece_contact.h"

namespace cdprep {
namespace {

PairCache* pair_of(PieceCache* cache) noexcept {
    return cache == nullptr ? nullptr : &cache->pair;
}

bool is_one_empty(const Model& a, const Model& b) noexcept {
    return a.triangle_count() == 0 || b.triangle_count() == 0;
}

PairFront* front_of(PieceCache* cache) noexcept {
    return cache == nullptr ? nullptr : &cache->front;
}

}  // namespace

std::optional<Distance> distance_through(const StructureOptions& through, const Model& a,
                                         const Model& b, const Placement& placement,
                                         Workspace& workspace, const DistanceOptions& options,
                                         PieceCache* cache) noexcept {
    const format::FloatEnvironment environment;
    require(a, b, Ask::distance | ask_of(through.structure));
    if (through.structure != Structure::pieces) {
        return distance(a, b, placement, workspace, options, pair_of(cache));
    }
    if (is_one_empty(a, b)) return std::nullopt;
    return distance_by<PieceTrees>(a, b, placement, workspace, options, pair_of(cache),
                                   front_of(cache));
}

bool is_within_through(const StructureOptions& through, const Model& a, const Model& b,
                       const Placement& placement, double tolerance, Workspace& workspace,
                       PieceCache* cache) noexcept {
    const format::FloatEnvironment environment;
    require(a, b, Ask::within | ask_of(through.structure));
    if (through.structure != Structure::pieces) {
        return is_within(a, b, placement, tolerance, workspace, pair_of(cache));
    }
    if (!(tolerance >= 0) || is_one_empty(a, b)) return false;
    if (tolerance == 0) return any_contact_of_pieces(a, b, placement, workspace, {}, cache);
    return is_within_by<PieceTrees>(a, b, placement, tolerance, workspace, pair_of(cache),
                                    front_of(cache));
}

}  // namespace cdprep
