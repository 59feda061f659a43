// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/contacts.h"
#include "core/moved_model.h"
#include "walk/find_contact.h"
#include "walk/inclusion.h"

namespace cdprep {

/// A component of one model of a pair that lies inside the other, whose surface it does not touch.
struct Enclosed {
    std::uint32_t component;
    bool is_of_a;
};

/// Calls visit(Enclosed) for each component that is proven to be enclosed, first those of B, until
/// it returns false. Calls it for none if any triangles touch. Returns false if `visit` did.
template <class Visit>
bool visit_enclosed(const Pair& pair, Workspace& workspace, Visit&& visit) noexcept {
    const MovedModel a = moved_a(pair.a, pair.placement), b = moved_b(pair.b, pair.placement);
    bool is_apart = false;  // known, once a component may be enclosed
    for (const bool is_of_a : {false, true}) {
        const MovedModel &inner = is_of_a ? a : b, &outer = is_of_a ? b : a;
        const std::span<const format::Component> components = inner.model->record().components;
        for (std::uint32_t i = 0; i < components.size(); ++i) {
            const Double3 vertex = inner.position(components[i].vertex);
            const Inclusion found = inclusion(outer, vertex, workspace.storage());
            if (found.on_surface || found.answer != Answer::yes) continue;
            if (!is_apart && find_contact(pair.a, pair.b, pair.placement, workspace,
                                          {.degenerate = pair.options.degenerate})) {
                return true;
            }
            is_apart = true;
            if (!visit(Enclosed{i, is_of_a})) return false;
        }
    }
    return true;
}

/// Returns the contact of an enclosed component: a way out of the hulls that enclose the other
/// model. These are its parts or the whole hull, if the file has them, else the box around it.
[[nodiscard]] Contact deep_contact(const Pair& pair, const Enclosed& enclosed, Manifold manifold,
                                   Workspace::Storage& scratch) noexcept;

}  // namespace cdprep
