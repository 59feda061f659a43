// SPDX-License-Identifier: MIT
#include "decompose/surface/contact_arrays.h"

#include <gtest/gtest.h>

#include "mesh/weld.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/run_threads.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using format::EdgeConvexity;

ContactArrays contact_arrays_of(const mesh::Mesh& mesh, ParallelFor parallel_for = serial_for) {
    const PieceArrays pieces = make_piece_arrays(mesh, find_surface_pieces(mesh), parallel_for);
    return make_contact_arrays(mesh, pieces, parallel_for);
}

std::array<int, 4> counts(const std::vector<std::uint8_t>& convexity) {
    std::array<int, 4> count{};
    for (const std::uint8_t bits : convexity) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++count[static_cast<std::size_t>(format::edge_convexity(bits, k))];
        }
    }
    return count;
}

TEST(ContactArrays, BitsOfThreeEdgesAreReadBack) {
    constexpr std::array kEdges = {EdgeConvexity::reflex, EdgeConvexity::unknown,
                                   EdgeConvexity::convex};
    constexpr std::uint8_t kBits = format::edge_convexity_bits(kEdges);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(format::edge_convexity(kBits, k), kEdges[k]);
}

// By hand: a cube has 12 convex edges and 6 flat diagonals, each used twice; inside out the
// convex ones are reflex.
TEST(ContactArrays, EdgesOfACubeAreConvexAndItsDiagonalsFlat) {
    EXPECT_EQ(counts(contact_arrays_of(test::welded(test::unit_cube())).convexity),
              (std::array{0, 12, 24, 0}));
    EXPECT_EQ(counts(contact_arrays_of(test::welded(test::reversed(test::unit_cube()))).convexity),
              (std::array{0, 12, 0, 24}));
}

// By hand: of three by two squares 10 sides are border; 7 sides and 6 diagonals are flat.
TEST(ContactArrays, BordersAreUnknown) {
    EXPECT_EQ(counts(contact_arrays_of(test::welded(test::grid_sheet(3, 2))).convexity),
              (std::array{10, 26, 0, 0}));
}

TEST(ContactArrays, EveryEdgeOfAHullLeadsToAFacetAndBack) {
    const mesh::Mesh mesh = test::welded(test::torus(2, 0.5, 24, 12));
    const PieceArrays pieces = make_piece_arrays(mesh, find_surface_pieces(mesh), serial_for);
    const ContactArrays arrays = make_contact_arrays(mesh, pieces, serial_for);
    ASSERT_EQ(arrays.adjacency.size(), pieces.facets.size());
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        const std::size_t first = pieces.pieces[i].first_facet;
        const std::size_t end =
            i + 1 < pieces.pieces.size() ? pieces.pieces[i + 1].first_facet : pieces.facets.size();
        for (std::size_t f = first; f < end; ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t g = first + arrays.adjacency[f].across[k];
                ASSERT_LT(g, end);
                const auto& from = pieces.facets[f].corner;
                const auto& to = pieces.facets[g].corner;
                int back = 0;
                for (std::size_t j = 0; j < 3; ++j) {
                    back += to[j] == from[(k + 1) % 3] && to[(j + 1) % 3] == from[k] &&
                            first + arrays.adjacency[g].across[j] == f;
                }
                EXPECT_EQ(back, 1);
            }
        }
    }
}

TEST(ContactArrays, EveryTriangleIsInThePieceThatListsIt) {
    const mesh::Mesh mesh = test::welded(test::torus(2, 0.5, 24, 12));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    const ContactArrays arrays =
        make_contact_arrays(mesh, make_piece_arrays(mesh, pieces, serial_for), serial_for);
    ASSERT_EQ(arrays.piece_of.size(), mesh.triangles.size());
    for (std::uint32_t i = 0; i < pieces.pieces.size(); ++i) {
        for (const std::uint32_t t : pieces.of(i)) EXPECT_EQ(arrays.piece_of[t], i);
    }
}

TEST(ContactArrays, ThreadsChangeNothing) {
    const mesh::Mesh mesh = test::welded(test::torus(2, 0.5, 48, 24));
    const ContactArrays one = contact_arrays_of(mesh),
                        many = contact_arrays_of(mesh, test::run_threads);
    EXPECT_EQ(one.convexity, many.convexity);
    EXPECT_TRUE(std::equal(one.adjacency.begin(), one.adjacency.end(), many.adjacency.begin(),
                           many.adjacency.end(),
                           [](const auto& a, const auto& b) { return a.across == b.across; }));
}

// The file's own triangles are asked, whatever their order: right bits pass, and any changed
// edge is found.
TEST(ContactArrays, DeepCheckFindsEveryEdgeThatIsNotAsStored) {
    const test::TestMesh torus = test::torus(2, 0.5, 8, 6);
    const test::AlignedBytes bare = test::bake_tiny(torus.positions, torus.triangles);
    const test::BuilderInput input = test::builder_input(Model::open(bare.span()).value());
    mesh::Mesh mesh;
    mesh.positions = input.positions;
    mesh.triangles = input.triangles;
    const std::vector<std::uint8_t> right =
        make_contact_arrays(mesh, PieceArrays{}, serial_for).convexity;
    const auto check = [&](const std::vector<std::uint8_t>& bits) {
        const test::OpenModel opened = test::open_tiny(test::with_sections(
            bare, {test::as_section(SectionId::edge_convexity, std::span(bits))}));
        return find_convexity_falsehood(opened.bytes.span(), opened.model);
    };
    EXPECT_FALSE(check(right));
    for (std::size_t i = 0; i < right.size(); ++i) {
        std::vector<std::uint8_t> wrong = right;
        wrong[i] ^= static_cast<std::uint8_t>(1U << (i % 6));
        const auto damage = check(wrong);
        ASSERT_TRUE(damage) << i;
        EXPECT_EQ(damage->kind, format::DamageKind::bad_fact);
        EXPECT_EQ(damage->found, wrong[i]);
        EXPECT_EQ(damage->limit, right[i]);
    }
}

}  // namespace
}  // namespace cdprep::convex
