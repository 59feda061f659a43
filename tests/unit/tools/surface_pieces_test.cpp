// SPDX-License-Identifier: MIT
#include "convex/surface_pieces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/weld.h"
#include "support/defect_zoo.h"
#include "support/meshes.h"
#include "unit/tools/pieces_flaw.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using test::TestMesh;

mesh::Mesh welded(const TestMesh& mesh) {
    return mesh::weld(test::soup_of(mesh)).mesh;
}

/// A polygon in the plane z = 0, counter-clockwise, drawn out to z = 1; `triangles` fill it.
TestMesh prism(const std::vector<std::array<double, 2>>& outline,
               const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    TestMesh mesh;
    const auto count = static_cast<std::uint32_t>(outline.size());
    for (const double z : {0.0, 1.0}) {
        for (const auto& p : outline) mesh.positions.push_back({p[0], p[1], z});
    }
    for (const auto& t : triangles) {
        mesh.triangles.push_back({{t[2], t[1], t[0]}});
        mesh.triangles.push_back({{count + t[0], count + t[1], count + t[2]}});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t j = (i + 1) % count;
        mesh.triangles.push_back({{i, j, count + j}});
        mesh.triangles.push_back({{i, count + j, count + i}});
    }
    return mesh;
}

TestMesh l_prism() {
    return prism({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
                 {{{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}});
}

TestMesh u_prism() {
    return prism({{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
                 {{{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}}});
}

TestMesh plus_prism() {
    return prism({{{1, 0},
                   {2, 0},
                   {2, 1},
                   {3, 1},
                   {3, 2},
                   {2, 2},
                   {2, 3},
                   {1, 3},
                   {1, 2},
                   {0, 2},
                   {0, 1},
                   {1, 1}}},
                 {{{0, 1, 2},
                   {0, 2, 11},
                   {2, 3, 4},
                   {2, 4, 5},
                   {5, 6, 7},
                   {5, 7, 8},
                   {8, 9, 10},
                   {8, 10, 11},
                   {2, 5, 8},
                   {2, 8, 11}}});
}

/// Everything that is promised of a closed solid.
void expect_sound(const mesh::Mesh& mesh, const SurfacePieces& pieces) {
    EXPECT_EQ(test::partition_flaw(mesh, pieces), "");
    EXPECT_EQ(test::hull_face_flaw(mesh, pieces), "");
    EXPECT_EQ(test::containment_flaw(mesh, pieces), "");
    for (const SurfacePiece& piece : pieces.pieces) EXPECT_EQ(piece.outer_error, 0);
}

constexpr std::array kOrders = {PieceOrder::greedy, PieceOrder::depth_first,
                                PieceOrder::breadth_first, PieceOrder::cresting};

TEST(SurfacePieces, AConvexCubeIsOnePieceIdenticalToItsHull) {
    const mesh::Mesh mesh = welded(test::unit_cube());
    for (const PieceOrder order : kOrders) {
        const SurfacePieces pieces = find_surface_pieces(mesh, {.order = order});
        ASSERT_EQ(pieces.pieces.size(), 1U);
        EXPECT_EQ(pieces.of(0).size(), 12U);
        EXPECT_TRUE(pieces.pieces[0].contained);
        EXPECT_EQ(convex_hull(test::piece_points(mesh, pieces.of(0))).facets.size(), 12U);
        expect_sound(mesh, pieces);
    }
}

// A scene of two nodes, of which one is convex: beside another it stays what it is alone.
TEST(SurfacePieces, AConvexNodeIsOnePieceBesideOthers) {
    const TestMesh ball = test::icosphere(2);
    const mesh::Mesh mesh = welded(test::joined(test::moved_by(ball, 1, {9, 0, 0}), l_prism()));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    EXPECT_EQ(pieces.of(0).size(), ball.triangles.size());
    EXPECT_EQ(pieces.of(0).back(), ball.triangles.size() - 1);
    expect_sound(mesh, pieces);
}

// By hand: the two walls of the notch meet at its only reflex edge and are in two pieces.
TEST(SurfacePieces, AnLPrismIsCutAtItsReflexEdge) {
    const mesh::Mesh mesh = welded(l_prism());
    for (const PieceOrder order : kOrders) {
        const SurfacePieces pieces = find_surface_pieces(mesh, {.order = order});
        EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::reflex)], 1U);
        EXPECT_GE(pieces.pieces.size(), 2U);
        EXPECT_LE(pieces.pieces.size(), 4U);
        for (const SurfacePiece& piece : pieces.pieces) EXPECT_TRUE(piece.contained);
        expect_sound(mesh, pieces);
    }
}

// D01: an icosphere is convex.
TEST(SurfacePieces, AConvexBodyOfManyTrianglesIsOnePiece) {
    const mesh::Mesh mesh = welded(test::icosphere(5));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    ASSERT_EQ(pieces.pieces.size(), 1U);
    EXPECT_TRUE(pieces.pieces[0].contained);
    EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::reflex)], 0U);
}

// D02
TEST(SurfacePieces, PrismsOverLettersAreCutIntoContainedPieces) {
    for (const TestMesh& letter : {l_prism(), u_prism(), plus_prism()}) {
        const mesh::Mesh mesh = welded(letter);
        for (const PieceOrder order : kOrders) {
            const SurfacePieces pieces = find_surface_pieces(mesh, {.order = order});
            EXPECT_GE(pieces.pieces.size(), 2U);
            for (const SurfacePiece& piece : pieces.pieces) EXPECT_TRUE(piece.contained);
            expect_sound(mesh, pieces);
        }
    }
}

}  // namespace
}  // namespace cdprep::convex
