// SPDX-License-Identifier: MIT
#include "cdprep/collide.h"

#include "contact_pairs.h"

namespace cdprep {

Collision collide(const Model& a, const Model& b, const Placement& placement, Workspace& workspace,
                  const CollideOptions& options) noexcept {
    Collision collision;
    const OverlapOptions pairs = {options.contact, options.degenerate};
    collision.hit = !for_each_contact<Search::first>(
        a, b, placement, workspace, pairs, [](std::uint32_t, std::uint32_t) { return false; });
    if (collision.hit || options.as == As::surface) return collision;
    collision.containment = find_containment(a, b, placement, workspace);
    collision.hit = collision.containment.answer == Answer::yes;
    return collision;
}

}  // namespace cdprep
