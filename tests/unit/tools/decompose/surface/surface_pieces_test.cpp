// SPDX-License-Identifier: MIT
#include "decompose/surface/surface_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/vectors.h"
#include "mesh/weld.h"
#include "support/concave_solids.h"
#include "support/defect_zoo.h"
#include "support/meshes.h"
#include "unit/tools/pieces_flaw.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using test::TestMesh;

/// Everything that is promised of a closed solid.
void expect_sound(const mesh::Mesh& mesh, const SurfacePieces& pieces) {
    EXPECT_EQ(test::partition_flaw(mesh, pieces), "");
    EXPECT_EQ(test::hull_face_flaw(mesh, pieces), "");
    EXPECT_EQ(test::containment_flaw(mesh, pieces), "");
    for (const SurfacePiece& piece : pieces.pieces) EXPECT_EQ(piece.outer_error, 0);
}

TEST(SurfacePieces, AConvexCubeIsOnePieceIdenticalToItsHull) {
    const mesh::Mesh mesh = test::welded(test::unit_cube());
    for (const PieceOrder order : test::kPieceOrders) {
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
    const mesh::Mesh mesh =
        test::welded(test::joined(test::moved_by(ball, 1, {9, 0, 0}), test::l_prism()));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    EXPECT_EQ(pieces.of(0).size(), ball.triangles.size());
    EXPECT_EQ(pieces.of(0).back(), ball.triangles.size() - 1);
    expect_sound(mesh, pieces);
}

// By hand: the two walls of the notch meet at its only reflex edge and are in two pieces.
TEST(SurfacePieces, AnLPrismIsCutAtItsReflexEdge) {
    const mesh::Mesh mesh = test::welded(test::l_prism());
    for (const PieceOrder order : test::kPieceOrders) {
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
    const mesh::Mesh mesh = test::welded(test::icosphere(5));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    ASSERT_EQ(pieces.pieces.size(), 1U);
    EXPECT_TRUE(pieces.pieces[0].contained);
    EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::reflex)], 0U);
}

// D02
TEST(SurfacePieces, PrismsOverLettersAreCutIntoContainedPieces) {
    for (const TestMesh& letter : {test::l_prism(), test::u_prism(), test::plus_prism()}) {
        const mesh::Mesh mesh = test::welded(letter);
        for (const PieceOrder order : test::kPieceOrders) {
            const SurfacePieces pieces = find_surface_pieces(mesh, {.order = order});
            EXPECT_GE(pieces.pieces.size(), 2U);
            for (const SurfacePiece& piece : pieces.pieces) EXPECT_TRUE(piece.contained);
            expect_sound(mesh, pieces);
        }
    }
}

// D03
TEST(SurfacePieces, CurvedConcaveBodiesAreCutIntoContainedPieces) {
    for (const TestMesh& body :
         {test::star(), test::torus(2, 0.5, 24, 12), test::spiral_stair(), test::trefoil_tube()}) {
        const mesh::Mesh mesh = test::welded(body);
        const SurfacePieces pieces = find_surface_pieces(mesh);
        EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::border)], 0U);
        EXPECT_GE(pieces.pieces.size(), 2U);
        EXPECT_LT(pieces.pieces.size(), mesh.triangles.size() / 2);
        for (const SurfacePiece& piece : pieces.pieces) EXPECT_TRUE(piece.contained);
        expect_sound(mesh, pieces);
    }
}

// D04: a box is convex however thin it is.
TEST(SurfacePieces, AThinBoxIsOnePiece) {
    for (const double thickness : {1e-3, 1e-12, 0x1p-300, 5e-324}) {
        TestMesh box = test::unit_cube();
        for (Double3& p : box.positions) p.z *= thickness;
        const mesh::Mesh mesh = test::welded(box);
        const SurfacePieces pieces = find_surface_pieces(mesh);
        ASSERT_EQ(pieces.pieces.size(), 1U) << thickness;
        EXPECT_TRUE(pieces.pieces[0].contained);
        expect_sound(mesh, pieces);
    }
}

// A plate of a solid that turns back over itself: its hull reaches over the gap.
TEST(SurfacePieces, AGapThinnerThanAnythingIsNotBridged) {
    for (const double gap : {0.25, 0x1p-40}) {
        TestMesh letter = test::u_prism();  // the notch is 1 <= x <= 2, y >= 1
        for (Double3& p : letter.positions) {
            if (p.x == 2) p.x = 1 + gap;
        }
        const mesh::Mesh mesh = test::welded(letter);
        const SurfacePieces pieces = find_surface_pieces(mesh);
        for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
            bool left = false, right = false;
            for (const Double3& p : test::piece_points(mesh, pieces.of(i))) {
                left = left || (p.x <= 1 && p.y == 2);
                right = right || (p.x >= 1 + gap && p.y == 2);
            }
            EXPECT_FALSE(left && right);
        }
        expect_sound(mesh, pieces);
    }
}

// D05: by hand. Three sheets of two triangles on an edge, which is a barrier.
TEST(SurfacePieces, AnEdgeOfThreeSheetsIsABarrier) {
    const SurfacePieces pieces = find_surface_pieces(test::welded(test::three_sheets()));
    EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::non_manifold)], 1U);
    ASSERT_EQ(pieces.pieces.size(), 3U);
    for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(pieces.of(i)[0], 2 * i);
        EXPECT_EQ(pieces.of(i)[1], 2 * i + 1);
        EXPECT_FALSE(pieces.pieces[i].contained);
    }
}

// D05: cubes with a vertex or an edge in common stay two convex bodies.
TEST(SurfacePieces, CubesThatShareAVertexOrAnEdgeAreTwoPieces) {
    for (const Double3& shift : {Double3{1, 1, 1}, Double3{1, 1, 0}}) {
        const mesh::Mesh mesh = test::welded(
            test::joined(test::unit_cube(), test::moved_by(test::unit_cube(), 1, shift)));
        const SurfacePieces pieces = find_surface_pieces(mesh);
        EXPECT_EQ(test::hull_face_flaw(mesh, pieces), "");
        EXPECT_EQ(test::containment_flaw(mesh, pieces), "");
        ASSERT_EQ(pieces.pieces.size(), 2U);
        EXPECT_EQ(pieces.of(0).size(), 12U);
        EXPECT_TRUE(pieces.pieces[0].contained);
        EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::non_manifold)],
                  shift.z == 0 ? 1U : 0U);
    }
}

// D06: its triangles cannot all be oriented: an odd number of edges is inconsistent.
TEST(SurfacePieces, AMoebiusStripIsCutAndContainsNothing) {
    const mesh::Mesh mesh = test::welded(test::moebius_strip(16));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::inconsistent)] % 2, 1U);
    for (const SurfacePiece& piece : pieces.pieces) EXPECT_FALSE(piece.contained);
    expect_sound(mesh, pieces);
}

// D06: no side of it can be called its outside, and it crosses itself; every triangle is on
// the hull of its piece all the same.
TEST(SurfacePieces, AKleinBottleIsCutAndContainsNothing) {
    const mesh::Mesh mesh = test::welded(test::klein_bottle(16, 11));
    for (const PieceOrder order : test::kPieceOrders) {
        const SurfacePieces pieces = find_surface_pieces(mesh, {.order = order});
        EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::border)], 0U);
        EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::inconsistent)], 11U);
        for (const SurfacePiece& piece : pieces.pieces) EXPECT_FALSE(piece.contained);
        expect_sound(mesh, pieces);
    }
}

// D07: half a sphere is convex, and bounds no solid.
TEST(SurfacePieces, AHemisphereIsOneUncontainedPiece) {
    const mesh::Mesh mesh = test::welded(test::upper_half(test::icosphere(3)));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    ASSERT_EQ(pieces.pieces.size(), 1U);
    EXPECT_FALSE(pieces.pieces[0].contained);
    EXPECT_GT(pieces.edges[static_cast<std::size_t>(EdgeKind::border)], 0U);
    expect_sound(mesh, pieces);
}

// D08: an inverted cube is reflex everywhere but in its six flat sides.
TEST(SurfacePieces, AnInvertedComponentIsCutIntoItsSides) {
    const mesh::Mesh mesh = test::welded(test::reversed(test::unit_cube()));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::reflex)], 12U);
    EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::flat)], 6U);
    EXPECT_EQ(pieces.pieces.size(), 6U);
    expect_sound(mesh, pieces);
}

// A ball within a ball, wound inwards, is a cavity: no hull may close over it. Wound
// outwards it is a body inside a body, and hides nothing.
TEST(SurfacePieces, ACavityIsKeptOpen) {
    const TestMesh outer = test::icosphere(1), inner = test::moved_by(outer, 0.5, {0, 0, 0});
    const mesh::Mesh hollow = test::welded(test::joined(outer, test::reversed(inner)));
    const SurfacePieces around = find_surface_pieces(hollow);
    EXPECT_GT(around.pieces.size(), 8U);
    for (const SurfacePiece& piece : around.pieces) EXPECT_TRUE(piece.contained);
    expect_sound(hollow, around);

    const mesh::Mesh nested = test::welded(test::joined(outer, inner));
    const SurfacePieces bodies = find_surface_pieces(nested);
    EXPECT_EQ(bodies.pieces.size(), 2U);
    EXPECT_EQ(test::hull_face_flaw(nested, bodies), "");
}

// D08: the zoo has every defect there is; each animal is cut, whatever it is.
TEST(SurfacePieces, EveryDefectIsTaken) {
    std::size_t taken = 0;
    for (const test::ZooAnimal& animal : test::defect_zoo()) {
        mesh::TriangleSoup soup = test::soup_of(animal.mesh);
        const bool bad =
            std::any_of(soup.positions.begin(), soup.positions.end(),
                        [](const Double3& p) { return !std::isfinite(p.x + p.y + p.z); });
        if (bad || animal.found.contains(102)) continue;
        const bool out_of_range = std::any_of(
            soup.triangles.begin(), soup.triangles.end(), [&](const format::Triangle& t) {
                return *std::max_element(t.vertex.begin(), t.vertex.end()) >= soup.positions.size();
            });
        if (out_of_range) continue;
        ++taken;
        const mesh::Mesh mesh = mesh::weld(soup).mesh;
        for (const PieceOrder order : test::kPieceOrders) {
            const SurfacePieces pieces = find_surface_pieces(mesh, {.order = order});
            EXPECT_EQ(test::partition_flaw(mesh, pieces), "") << animal.name;
            EXPECT_EQ(test::hull_face_flaw(mesh, pieces), "") << animal.name;
        }
    }
    EXPECT_GE(taken, 20U);
}

// D10: a vertex of a flat strip a step below its neighbours makes their edges reflex or
// convex, by the exact sign; a step is far below what doubles tell apart there.
TEST(SurfacePieces, AVertexOneStepLowMakesReflexEdges) {
    const auto strip = [](double height) {
        TestMesh mesh = test::grid_sheet(2, 1);
        for (Double3& p : mesh.positions) {
            p.z = 1;
            if (p.x == 1) p.z = height;
        }
        return find_surface_edges(test::welded(mesh), serial_for).count;
    };
    const auto flat = static_cast<std::size_t>(EdgeKind::flat);
    const auto reflex = static_cast<std::size_t>(EdgeKind::reflex);
    const auto convex = static_cast<std::size_t>(EdgeKind::convex);
    EXPECT_EQ(strip(1)[flat], 3U);
    EXPECT_EQ(strip(std::nextafter(1.0, 0))[reflex], 1U);
    EXPECT_EQ(strip(std::nextafter(1.0, 2))[convex], 1U);
    EXPECT_EQ(strip(std::nextafter(1.0, 2))[reflex], 0U);
}

// D11: one side of the box is 10,000 triangles in one plane, and the box is convex.
TEST(SurfacePieces, TenThousandCoplanarTrianglesAreOnePiece) {
    const SurfacePieces open = find_surface_pieces(test::welded(test::grid_sheet(100, 50)));
    EXPECT_EQ(open.pieces.size(), 1U);

    const mesh::Mesh mesh = test::welded(test::box_with_a_fine_side(100, 50));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    ASSERT_EQ(pieces.pieces.size(), 1U);
    EXPECT_TRUE(pieces.pieces[0].contained);
    EXPECT_EQ(convex_hull(test::piece_points(mesh, pieces.of(0))).groups.size(), 7U);
}

// By hand: a triangle without area has no side; it is a piece, and its neighbours end there.
TEST(SurfacePieces, ATriangleWithoutAreaIsAPieceOfItsOwn) {
    TestMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}};
    mesh.triangles = {{{0, 1, 3}}, {{1, 2, 3}}, {{0, 2, 1}}, {{0, 4, 2}}};
    const mesh::Mesh whole = test::welded(mesh);
    const SurfacePieces pieces = find_surface_pieces(whole);
    EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::no_area)], 3U);
    ASSERT_EQ(pieces.pieces.size(), 3U);
    EXPECT_EQ(pieces.of(0).size(), 2U);
    EXPECT_EQ(pieces.of(1)[0], 2U);
    expect_sound(whole, pieces);
}

TEST(SurfacePieces, NothingHasNoPieces) {
    EXPECT_TRUE(find_surface_pieces({}).pieces.empty());
}

// The hull of the outer surface fills the cavity. With a tolerance it may be one piece, which then
// makes no promise. The oracle is exact.
TEST(SurfacePieces, ToleranceContainsNothingAroundACavity) {
    const TestMesh outer = test::moved_by(test::unit_cube(), 10, {});
    const TestMesh inner = test::moved_by(test::unit_cube(), 8, {1, 1, 1});
    const mesh::Mesh hollow = test::welded(test::joined(outer, test::reversed(inner)));
    const mesh::Mesh full = test::welded(outer);
    for (const PieceOrder order : test::kPieceOrders) {
        const SurfacePieces pieces =
            find_surface_pieces(hollow, {.order = order, .tolerance = 1e-3});
        EXPECT_EQ(test::partition_flaw(hollow, pieces), "");
        EXPECT_EQ(test::containment_flaw(hollow, pieces), "");
        EXPECT_EQ(pieces.of(0).size(), 12U);
        EXPECT_FALSE(pieces.pieces[0].contained);
        // Without the cavity, it contains its hull.
        const SurfacePieces alone = find_surface_pieces(full, {.order = order, .tolerance = 1e-3});
        EXPECT_EQ(alone.of(0).size(), 12U);
        EXPECT_TRUE(alone.pieces[0].contained);
    }
}

// Two faces of a roof, the other way around: each vertex is far above the other face. Lengths of
// normals overflow where squares of areas do, and bounds must not become 0.
TEST(SurfacePieces, BoundsWithAToleranceHoldForEverySize) {
    TestMesh valley;
    valley.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 1}, {1, 2, 0.25}, {0, 2, 0.25}};
    valley.triangles = {{{0, 2, 1}}, {{0, 3, 2}}, {{3, 4, 2}}, {{3, 5, 4}}};
    for (const double size : {1.0, 1e60, 1e74, 1e76, 1e78, 1e80, 1e90, 1e99, 1e101, 1e150, 1e300}) {
        const mesh::Mesh mesh = test::welded(test::moved_by(valley, size, {}));
        const SurfacePieces pieces = find_surface_pieces(mesh, {.tolerance = 10 * size});
        for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
            double highest = 0;
            for (const std::uint32_t t : pieces.of(i)) {
                const auto& v = mesh.triangles[t].vertex;
                const auto at = [&](std::uint32_t vertex) {
                    const Double3& p = mesh.positions[vertex];
                    return Double3{p.x / size, p.y / size, p.z / size};
                };
                const Double3 a = at(v[0]);
                const Double3 n = mesh::cross(mesh::minus(at(v[1]), a), mesh::minus(at(v[2]), a));
                for (const std::uint32_t other : pieces.of(i)) {
                    for (const std::uint32_t vertex : mesh.triangles[other].vertex) {
                        highest = std::max(
                            highest, mesh::dot(n, mesh::minus(at(vertex), a)) / mesh::length(n));
                    }
                }
            }
            EXPECT_GE(pieces.pieces[i].outer_error / size, highest - 1e-9) << size;
        }
        if (size < 1e75) {
            EXPECT_EQ(pieces.pieces.size(), 1U) << size;
        }
    }
}

// A step of 1/16 across a bar: with less tolerance it is cut, with more it is not, and
// what is stated is no more than what was allowed and no less than the step.
TEST(SurfacePieces, ToleranceBridgesAStepAndStatesIt) {
    const mesh::Mesh mesh = test::welded(test::prism(
        {{{0, 0}, {4, 0}, {4, 1}, {2, 0.9375}, {0, 1}}}, {{{0, 1, 3}, {1, 2, 3}, {0, 3, 4}}}));
    EXPECT_GT(find_surface_pieces(mesh, {.tolerance = 0.03}).pieces.size(), 1U);
    const SurfacePieces pieces = find_surface_pieces(mesh, {.tolerance = 0.125});
    ASSERT_EQ(pieces.pieces.size(), 1U);
    EXPECT_FALSE(pieces.pieces[0].contained);
    EXPECT_LE(pieces.pieces[0].outer_error, 0.125);
    // The ends of the top are this much above the planes of its other half.
    const double above = 0.125 * 2 / std::hypot(2, 0.0625);
    EXPECT_GE(pieces.pieces[0].outer_error, above * (1 - 1e-12));
    EXPECT_LE(pieces.pieces[0].outer_error, above * (1 + 1e-9));
}

}  // namespace
}  // namespace cdprep::convex
