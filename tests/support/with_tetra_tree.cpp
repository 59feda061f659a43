// SPDX-License-Identifier: MIT
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::test {

AlignedBytes with_tetra_tree(const AlignedBytes& file, build::TetraTreeOptions options) {
    const OpenModel open = open_tiny(AlignedBytes(file.span()));
    options.frame_exponent = open.model.header().frame_exponent;
    options.frame_origin = open.model.header().frame_origin;
    const BuilderInput input = builder_input(open.model);
    const build::TetraTree tree =
        build::build_tetra_tree(input.positions, input.triangles, options);
    std::vector<TinySection> sections = {
        as_section(SectionId::tetra_tree, std::span(&tree.tree, 1)),
        as_section(SectionId::tetra_nodes, std::span(std::as_const(tree.nodes))),
        as_section(SectionId::tetra_references, std::span(std::as_const(tree.references))),
        as_section(SectionId::tetra_top, std::span(std::as_const(tree.top)))};
    if (options.bounding == format::TetraBounding::boxes) {
        sections.push_back(
            as_section(SectionId::tetra_boxes, std::span(std::as_const(tree.boxes))));
        sections.push_back(
            as_section(SectionId::tetra_oriented, std::span(std::as_const(tree.oriented))));
    }
    return with_sections(file, std::move(sections));
}

}  // namespace cdprep::test
