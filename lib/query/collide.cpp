// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "cdprep/study/overlap_through.h"
#include "core/require.h"
#include "walk/find_contact.h"

namespace cdprep {
namespace {

bool any_overlap(const Pair& pair, Workspace& workspace) noexcept {
    const Structure through = pair.options.through;
    if (through == Structure::bvh) {
        return any_contact(pair.a, pair.b, pair.placement, workspace, pair.options, pair.cache);
    }
    return any_overlap_through(pair, {.structure = through}, workspace);
}

}  // namespace

Collision collide(const Pair& pair, Workspace& workspace) noexcept {
    const format::FloatEnvironment environment;
    const bool is_solid = pair.options.body == Body::solid;
    require(pair.a, pair.b, is_solid ? Ask::collide | Ask::solid : Ask::collide);
    if (any_overlap(pair, workspace)) return {Answer::yes, {}};
    if (!is_solid) return {};
    const Containment inside = containment(pair, workspace);
    return {inside.answer, inside};
}

}  // namespace cdprep
