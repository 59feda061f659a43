// SPDX-License-Identifier: MIT
#include "walk/find_contact.h"

#include "walk/contact_pairs.h"

namespace cdprep {

std::optional<TreePair> find_contact(const Model& a, const Model& b, const Placement& placement,
                                     Workspace& workspace, const PairOptions& options) noexcept {
    return find_contact_by<TriangleTrees>(a, b, placement, workspace, options);
}

}  // namespace cdprep
