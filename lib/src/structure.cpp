// SPDX-License-Identifier: MIT
#include "cdprep/structure.h"

#include "cdprep/format/file_header.h"

namespace cdprep {

using format::SectionId;

format::SectionSet sections_of(Structure structure) noexcept {
    switch (structure) {
        case Structure::octree:
            return {SectionId::octree_grid, SectionId::octree_nodes, SectionId::octree_references};
        case Structure::adaptive_octree:
            return {SectionId::adaptive_octree, SectionId::adaptive_octree_nodes,
                    SectionId::adaptive_octree_references};
        case Structure::hashed_octree:
        case Structure::hashed_octree_literal:
            return {SectionId::octree_grid,          SectionId::octree_nodes,
                    SectionId::octree_references,    SectionId::octree_leaf_codes,
                    SectionId::octree_leaf_nodes,    SectionId::octree_top,
                    SectionId::octree_modulus_table, SectionId::octree_mixed_table};
        case Structure::tetra_tree:
            return {SectionId::tetra_tree, SectionId::tetra_nodes, SectionId::tetra_references,
                    SectionId::tetra_top};
        case Structure::pieces:
            return {SectionId::pieces,       SectionId::piece_triangles,  SectionId::piece_nodes,
                    SectionId::piece_leaves, SectionId::piece_node_hulls, SectionId::piece_swept};
        default:
            return {};
    }
}

format::SectionSet more_sections_of(Structure structure) noexcept {
    switch (structure) {
        case Structure::octree:
        case Structure::hashed_octree:
            return {SectionId::octree_boxes};
        case Structure::adaptive_octree:
            return {SectionId::adaptive_octree_boxes};
        case Structure::tetra_tree:
            return {SectionId::tetra_boxes, SectionId::tetra_oriented};
        default:
            return {};
    }
}

}  // namespace cdprep
