// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "core/triangle_facts.h"
#include "walk/inclusion.h"

namespace cdprep {
namespace {

/// As find_inside(), where the surfaces touch without a proper overlap, and `outer` is balanced. A
/// corner that is inside proves that its component is.
Containment find_inside_by_corners(const MovedModel& inner, const MovedModel& outer,
                                   Workspace::Storage& scratch, bool a_inside_b) noexcept {
    Containment result;
    bool some_outside = false;  // triangles with a corner outside
    bool some_lie = false;      // triangles with all corners on the surface
    each_triangle(*inner.model, 0, inner.model->triangle_count(), [&](std::uint32_t i) {
        bool lies = true;
        for (const Double3& corner : inner.corners(i)) {
            const Inclusion found = inclusion(outer, corner, scratch);
            if (found.on_surface) continue;
            if (found.answer == Answer::yes) {
                result = {Answer::yes, found.winding, a_inside_b};
                return false;
            }
            lies = false;
        }
        (lies ? some_lie : some_outside) = true;
        return true;
    });
    if (result.answer == Answer::yes) return result;
    // All corners of a component may lie on the surface: it is inside or outside.
    const bool is_single = inner.model->record().components.size() == 1;
    const bool is_unknown = is_single ? !some_outside : some_lie;
    return is_unknown ? Containment{Answer::unknown, 0, a_inside_b} : Containment{};
}

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
    bool touches = false;
    for (const format::Component& component : inner.model->record().components) {
        const Inclusion found = inclusion(outer, inner.position(component.vertex), scratch);
        if (found.on_surface && outer.model->is_balanced()) {
            touches = true;
            continue;
        }
        if (found.answer == Answer::no) continue;
        if (found.answer == Answer::yes && !found.on_surface) {
            return {Answer::yes, found.winding, a_inside_b};
        }
        if (result.answer == Answer::no) result = {Answer::unknown, found.winding, a_inside_b};
    }
    if (!touches) return result;
    const Containment by_corners = find_inside_by_corners(inner, outer, scratch, a_inside_b);
    const bool is_better = by_corners.answer == Answer::yes || result.answer == Answer::no;
    return is_better ? by_corners : result;
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
