// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "walk/inclusion.h"

namespace cdprep {
namespace {

/// Returns whether a component of `inner` lies inside `outer`.
Containment find_inside(const MovedModel& inner, const MovedModel& outer,
                        Workspace::Storage& scratch, bool a_inside_b) noexcept {
    // The components of a torn model may have come apart: a vertex of each does not decide.
    if (inner.model->is_torn()) {
        const bool may_be_inside = inner.model->triangle_count() > 0 &&
                                   outer.model->triangle_count() > 0 &&
                                   overlap(box_around(inner), box_around(outer));
        return {may_be_inside ? Answer::unknown : Answer::no, 0, a_inside_b};
    }
    if (inner.model->triangle_count() == 0) return {};
    Containment result;
    for (const format::Component& component : inner.model->record().components) {
        const Inclusion found = inclusion(outer, inner.position(component.vertex), scratch);
        if (found.on_surface || found.answer == Answer::no) continue;
        if (found.answer == Answer::yes) return {Answer::yes, found.winding, a_inside_b};
        if (result.answer == Answer::no) result = {Answer::unknown, found.winding, a_inside_b};
    }
    return result;
}

}  // namespace

Containment containment(const Pair& pair, Workspace& workspace) noexcept {
    const format::FloatEnvironment environment;
    require(pair.a, pair.b, Ask::solid);
    const MovedModel in_a = moved_a(pair.a, pair.placement);
    const MovedModel in_b = moved_b(pair.b, pair.placement);
    Workspace::Storage& scratch = workspace.storage();
    const Containment a_in_b = find_inside(in_a, in_b, scratch, true);
    if (a_in_b.answer == Answer::yes) return a_in_b;
    const Containment b_in_a = find_inside(in_b, in_a, scratch, false);
    if (b_in_a.answer == Answer::yes || a_in_b.answer == Answer::no) return b_in_a;
    return a_in_b;
}

}  // namespace cdprep
