// SPDX-License-Identifier: MIT
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::test {

AlignedBytes with_adaptive_octree(const AlignedBytes& file,
                                  const build::AdaptiveOctreeOptions& options) {
    const OpenModel open = open_tiny(AlignedBytes(file.span()));
    const BuilderInput input = builder_input(open.model);
    const build::AdaptiveOctree tree =
        build::build_adaptive_octree(input.positions, input.triangles, options);
    return with_sections(
        file, {as_section(SectionId::adaptive_octree, std::span(&tree.tree, 1)),
               as_section(SectionId::adaptive_octree_nodes, std::span(std::as_const(tree.nodes))),
               as_section(SectionId::adaptive_octree_references,
                          std::span(std::as_const(tree.references)))});
}

}  // namespace cdprep::test
