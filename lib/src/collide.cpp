// SPDX-License-Identifier: MIT
#include "cdprep/collide.h"

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "find_contact.h"

namespace cdprep {

Collision collide(const Model& a, const Model& b, const Placement& placement, Workspace& workspace,
                  const CollideOptions& options, PairCache* cache) noexcept {
    const format::FloatEnvironment environment;
    require(a, b, options.body == Body::solid ? Ask::collide | Ask::solid : Ask::collide);
    Collision collision;
    const OverlapOptions pairs = {options.overlap, options.degenerate};
    collision.hit = any_contact(a, b, placement, workspace, pairs, cache);
    if (collision.hit || options.body == Body::surface) return collision;
    collision.containment = find_containment(a, b, placement, workspace);
    collision.hit = collision.containment.answer == Answer::yes;
    return collision;
}

}  // namespace cdprep
