// SPDX-License-Identifier: MIT
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::test {

AlignedBytes with_octree(const AlignedBytes& file, build::OctreeOptions options) {
    const OpenModel open = open_tiny(AlignedBytes(file.span()));
    const format::FileHeader& header = open.model.header();
    if (options.boxes_in) options.boxes_in = {header.frame_origin, header.frame_exponent};
    const BuilderInput input = builder_input(open.model);
    const build::Octree tree = build::build_octree(input.positions, input.triangles, options);
    const auto section = [](SectionId id, const auto& elements) {
        return as_section(id, std::span(elements));
    };
    std::vector<TinySection> made = {
        as_section(SectionId::octree_grid, std::span(&tree.grid, 1)),
        section(SectionId::octree_nodes, tree.nodes),
        section(SectionId::octree_references, tree.references),
    };
    if (options.hashed) {
        made.push_back(section(SectionId::octree_leaf_codes, tree.leaf_codes));
        made.push_back(section(SectionId::octree_leaf_nodes, tree.leaf_nodes));
        made.push_back(section(SectionId::octree_top, tree.top));
        made.push_back(section(SectionId::octree_modulus_table, tree.modulus_table));
        made.push_back(section(SectionId::octree_mixed_table, tree.mixed_table));
    }
    if (options.boxes_in) made.push_back(section(SectionId::octree_boxes, tree.boxes));
    return with_sections(file, std::move(made));
}

}  // namespace cdprep::test
