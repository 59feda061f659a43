// SPDX-License-Identifier: MIT
#include "cdprep/pairs.h"

#include <algorithm>

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "core/smallest.h"
#include "exact/edge_on_plane.h"
#include "walk/contact_pairs.h"

namespace cdprep {

namespace {

struct ByPair {
    bool operator()(const Crossing& x, const Crossing& y) const noexcept {
        return x.pair < y.pair;
    }
};

}  // namespace

std::size_t crossings(const Pair& pair, Workspace& workspace, std::span<Crossing> room) noexcept {
    Smallest<Crossing, ByPair> smallest(room);
    const auto keep = [&](const Crossing& crossing) {
        smallest.add(crossing);
        return true;
    };
    visit_crossings(pair, workspace, keep);
    const std::span<Crossing> kept = smallest.kept();
    std::sort(kept.begin(), kept.end(), ByPair());
    return smallest.count();
}

bool visit_crossings(const Pair& pair, Workspace& workspace, Visitor<Crossing> visit) noexcept {
    format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::overlap);
    const MovedModel in_a = moved_a(a, pair.placement);
    const MovedModel in_b = moved_b(b, pair.placement);
    return for_each_contact<Search::all>(
        a, b, pair.placement, workspace, pair.options, [&](std::uint32_t at_a, std::uint32_t at_b) {
            const Corners s = in_a.corners(at_a);
            const Corners t = in_b.corners(at_b);
            Crossing crossing{{source_number(a, at_a), source_number(b, at_b)}, true, {}, {}};
            if (const auto ends = crossing_ends(s, t)) {
                const auto point = [&](const PiercingEdge& edge) {
                    return edge_on_plane(edge.from, edge.to, edge.of_a ? t : s);
                };
                crossing.is_flat = false;
                crossing.from = point(ends->first);
                crossing.to = ends->is_point ? crossing.from : point(ends->second);
            }
            return environment.outside([&] { return visit(crossing); });
        });
}

}  // namespace cdprep
