// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "pieces/piece_contact.h"
#include "walk/cell_searches.h"
#include "walk/find_contact.h"

namespace cdprep {
namespace {

bool any_overlap(const Pair& pair, Workspace& workspace) noexcept {
    switch (pair.options.through) {
        case Structure::bvh:
            return any_contact(pair.a, pair.b, pair.placement, workspace, pair.options, pair.cache);
        case Structure::pieces:
            return any_contact_of_pieces(pair.a, pair.b, pair.placement, workspace, pair.options,
                                         pair.cache);
        default:
            return require_cells(workspace).any_overlap(pair, workspace);
    }
}

}  // namespace

Collision collide(const Pair& pair, Workspace& workspace) noexcept {
    const format::FloatEnvironment environment;
    const bool is_solid = pair.options.body == Body::solid;
    const Ask asks = Ask::collide | ask_of(pair.options.through);
    require(pair.a, pair.b, is_solid ? asks | Ask::solid : asks);
    if (any_overlap(pair, workspace)) return {Answer::yes, {}};
    if (!is_solid) return {};
    const Containment inside = containment(pair, workspace);
    return {inside.answer, inside};
}

}  // namespace cdprep
