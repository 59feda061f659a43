// SPDX-License-Identifier: MIT
#include "cdprep/advanced/section_list.h"

namespace cdprep::build {

using format::SectionId;

void add_sections(SectionList& list, const Bvh& bvh) {
    list.add(SectionId::source_triangle, bvh.order);
    list.add(SectionId::bvh_nodes, bvh.nodes);
    list.add(SectionId::bvh_leaves, bvh.leaves);
    list.add_unless_empty(SectionId::oriented_nodes, bvh.oriented_nodes);
    list.add_unless_empty(SectionId::swept_nodes, bvh.swept_nodes);
}

}  // namespace cdprep::build
