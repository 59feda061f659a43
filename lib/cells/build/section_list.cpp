// SPDX-License-Identifier: MIT
#include "cdprep/cells/section_list.h"

namespace cdprep::build {

using format::SectionId;

void add_sections(SectionList& list, const Octree& octree) {
    list.add_one(SectionId::octree_grid, octree.grid);
    list.add(SectionId::octree_nodes, octree.nodes);
    list.add(SectionId::octree_references, octree.references);
    list.add(SectionId::octree_leaf_codes, octree.leaf_codes);
    list.add(SectionId::octree_leaf_nodes, octree.leaf_nodes);
    list.add(SectionId::octree_top, octree.top);
    list.add(SectionId::octree_modulus_table, octree.modulus_table);
    list.add(SectionId::octree_mixed_table, octree.mixed_table);
    list.add(SectionId::octree_boxes, octree.boxes);
}

void add_sections(SectionList& list, const AdaptiveOctree& octree) {
    list.add_one(SectionId::adaptive_octree, octree.tree);
    list.add(SectionId::adaptive_octree_nodes, octree.nodes);
    list.add(SectionId::adaptive_octree_references, octree.references);
    list.add(SectionId::adaptive_octree_boxes, octree.boxes);
}

void add_sections(SectionList& list, const TetraTree& tetra) {
    list.add_one(SectionId::tetra_tree, tetra.tree);
    list.add(SectionId::tetra_nodes, tetra.nodes);
    list.add(SectionId::tetra_references, tetra.references);
    list.add(SectionId::tetra_top, tetra.top);
    list.add(SectionId::tetra_boxes, tetra.boxes);
    list.add(SectionId::tetra_oriented, tetra.oriented);
}

}  // namespace cdprep::build
