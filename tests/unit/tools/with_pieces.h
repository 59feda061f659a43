// SPDX-License-Identifier: MIT
#pragma once

#include "decompose/surface/contact_arrays.h"
#include "decompose/surface/piece_tree.h"
#include "decompose/surface/surface_pieces.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "unit/tools/soup_of.h"

namespace cdprep::test {

/// How the triangles of a test's model are put into pieces.
enum class PiecesOf : std::uint8_t {
    surface,   ///< as bakes do it
    triangles  ///< each by itself, contained in nothing
};

inline convex::SurfacePieces single_triangles(std::size_t count) {
    convex::SurfacePieces pieces;
    for (std::uint32_t t = 0; t < count; ++t) {
        pieces.triangles.push_back(t);
        pieces.first.push_back(t);
        pieces.pieces.push_back({});
    }
    pieces.first.push_back(static_cast<std::uint32_t>(count));
    return pieces;
}

/// A file with pieces, the hierarchy over them and what contacts need.
inline AlignedBytes bake_with_pieces(const TestMesh& test_mesh, PiecesOf kind = PiecesOf::surface,
                                     const convex::SurfacePieceOptions& options = {}) {
    const AlignedBytes bare =
        bake_tiny(test_mesh.positions, test_mesh.triangles, {.double_precision = true});
    const Model model = Model::open(bare.span()).value();
    const BuilderInput input = builder_input(model);
    const mesh::Mesh mesh = mesh_of({input.positions, input.triangles});
    const convex::PieceArrays pieces = convex::make_piece_arrays(
        mesh,
        kind == PiecesOf::surface ? convex::find_surface_pieces(mesh, options)
                                  : single_triangles(mesh.triangles.size()),
        serial_for);
    const convex::ContactArrays contacts = convex::make_contact_arrays(mesh, pieces, serial_for);
    const format::FileHeader& header = model.header();
    const convex::PieceTree tree = convex::make_piece_tree(
        mesh, pieces, {header.frame_origin, header.frame_exponent}, serial_for);
    return with_sections(bare,
                         {as_section(SectionId::pieces, std::span(pieces.pieces)),
                          as_section(SectionId::piece_triangles, std::span(pieces.triangles)),
                          as_section(SectionId::piece_vertices, std::span(pieces.vertices)),
                          as_section(SectionId::piece_facets, std::span(pieces.facets)),
                          as_section(SectionId::piece_nodes, std::span(tree.nodes)),
                          as_section(SectionId::piece_swept, std::span(tree.swept)),
                          as_section(SectionId::piece_leaves, std::span(tree.leaves)),
                          as_section(SectionId::piece_node_hulls, std::span(tree.hulls)),
                          as_section(SectionId::piece_adjacency, std::span(contacts.adjacency)),
                          as_section(SectionId::edge_convexity, std::span(contacts.convexity)),
                          as_section(SectionId::triangle_piece, std::span(contacts.piece_of))});
}

inline OpenModel open_with_pieces(const TestMesh& test_mesh, PiecesOf kind = PiecesOf::surface,
                                  const convex::SurfacePieceOptions& options = {}) {
    return open_tiny(bake_with_pieces(test_mesh, kind, options));
}

}  // namespace cdprep::test
