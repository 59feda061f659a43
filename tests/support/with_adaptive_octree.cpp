// SPDX-License-Identifier: MIT
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::test {

AlignedBytes with_adaptive_octree(const AlignedBytes& file, build::AdaptiveOctreeOptions options) {
    const OpenModel open = open_tiny(AlignedBytes(file.span()));
    const format::FileHeader& header = open.model.header();
    if (options.boxes_in) options.boxes_in = {header.frame_origin, header.frame_exponent};
    const BuilderInput input = builder_input(open.model);
    const build::AdaptiveOctree tree =
        build::build_adaptive_octree(input.positions, input.triangles, options);
    std::vector<TinySection> made = {
        as_section(SectionId::adaptive_octree, std::span(&tree.tree, 1)),
        as_section(SectionId::adaptive_octree_nodes, std::span(std::as_const(tree.nodes))),
        as_section(SectionId::adaptive_octree_references,
                   std::span(std::as_const(tree.references)))};
    if (options.boxes_in) {
        made.push_back(
            as_section(SectionId::adaptive_octree_boxes, std::span(std::as_const(tree.boxes))));
    }
    return with_sections(file, std::move(made));
}

}  // namespace cdprep::test
