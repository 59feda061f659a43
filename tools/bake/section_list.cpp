// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/section_list.h"

namespace cdprep::convex {

using format::SectionId;

void add_sections(build::SectionList& list, const HullSections& hulls) {
    list.add(SectionId::hulls, hulls.hulls);
    list.add(SectionId::hull_blocks, hulls.blocks);
    list.add(SectionId::hull_vertices, hulls.vertices);
    list.add(SectionId::hull_facets, hulls.facets);
    list.add(SectionId::hull_groups, hulls.groups);
    list.add(SectionId::hull_neighbours, hulls.neighbours);
    list.add(SectionId::hull_starts, hulls.starts);
}

void add_sections(build::SectionList& list, const PieceArrays& pieces) {
    list.add(SectionId::pieces, pieces.pieces);
    list.add(SectionId::piece_triangles, pieces.triangles);
    list.add(SectionId::piece_vertices, pieces.vertices);
    list.add(SectionId::piece_facets, pieces.facets);
}

void add_sections(build::SectionList& list, const PieceTree& tree) {
    list.add(SectionId::piece_nodes, tree.nodes);
    list.add(SectionId::piece_swept, tree.swept);
    list.add(SectionId::piece_leaves, tree.leaves);
    list.add(SectionId::piece_node_hulls, tree.hulls);
}

void add_sections(build::SectionList& list, const ContactArrays& contacts) {
    list.add(SectionId::piece_adjacency, contacts.adjacency);
    list.add(SectionId::edge_convexity, contacts.convexity);
    list.add(SectionId::triangle_piece, contacts.piece_of);
}

}  // namespace cdprep::convex
