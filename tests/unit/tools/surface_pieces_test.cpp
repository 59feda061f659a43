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

/// A body of revolution about z: rings of `count` corners, closed by fans to two points.
TestMesh turned(const std::vector<std::array<double, 2>>& radius_and_height, int count) {
    TestMesh mesh;
    const auto n = static_cast<std::uint32_t>(count);
    const auto rings = static_cast<std::uint32_t>(radius_and_height.size());
    for (const auto& [radius, height] : radius_and_height) {
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * std::acos(-1.0) * i / count;
            mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
        }
    }
    mesh.positions.push_back({0, 0, radius_and_height.front()[1]});
    mesh.positions.push_back({0, 0, radius_and_height.back()[1]});
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        for (std::uint32_t k = 0; k + 1 < rings; ++k) {
            const std::uint32_t a = k * n, b = a + n;
            mesh.triangles.push_back({{a + i, a + j, b + j}});
            mesh.triangles.push_back({{a + i, b + j, b + i}});
        }
        mesh.triangles.push_back({{rings * n, j, i}});
        mesh.triangles.push_back({{rings * n + 1, (rings - 1) * n + i, (rings - 1) * n + j}});
    }
    return mesh;
}

/// A square tube along a curve: `at` gives the middle of each ring and its two axes.
template <class At>
TestMesh tube(int rings, bool is_closed, At at) {
    TestMesh mesh;
    for (int i = 0; i < rings; ++i) {
        for (const Double3& corner : at(i)) mesh.positions.push_back(corner);
    }
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({{a, b, c}});
        mesh.triangles.push_back({{a, c, d}});
    };
    const auto count = static_cast<std::uint32_t>(rings);
    for (std::uint32_t i = 0; i + (is_closed ? 0 : 1) < count; ++i) {
        const std::uint32_t a = 4 * i, b = 4 * ((i + 1) % count);
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t l = (k + 1) % 4;
            quad(a + k, a + l, b + l, b + k);
        }
    }
    if (!is_closed) {
        quad(3, 2, 1, 0);
        const std::uint32_t z = 4 * (count - 1);
        quad(z, z + 1, z + 2, z + 3);
    }
    return mesh;
}

/// A ring of four points around `middle`, spanned by two directions.
std::array<Double3, 4> ring_of(const Double3& middle, const Double3& u, const Double3& w) {
    const auto corner = [&](double s, double t) {
        return Double3{middle.x + s * u.x + t * w.x, middle.y + s * u.y + t * w.y,
                       middle.z + s * u.z + t * w.z};
    };
    return {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
}

TestMesh spiral_stair() {
    constexpr int kRings = 60;
    return tube(kRings, false, [](int i) {
        const double angle = 0.3 * i, c = std::cos(angle), s = std::sin(angle);
        return ring_of({3 * c, 3 * s, 0.15 * i}, {0.8 * c, 0.8 * s, 0}, {0, 0, 0.25});
    });
}

TestMesh trefoil_tube() {
    constexpr int kRings = 96;
    return tube(kRings, true, [](int i) {
        const double t = 2 * std::acos(-1.0) * i / kRings;
        const Double3 middle = {std::sin(t) + 2 * std::sin(2 * t),
                                std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
        // Across the curve, and outwards enough not to be along it.
        const Double3 along = {std::cos(t) + 4 * std::cos(2 * t),
                               -std::sin(t) + 4 * std::sin(2 * t), -3 * std::cos(3 * t)};
        const double flat = std::hypot(along.x, along.y);
        const Double3 u = {0.2 * along.y / flat, -0.2 * along.x / flat, 0};
        const double length = std::hypot(flat, along.z);
        const Double3 w = {-0.2 * along.x * along.z / (flat * length),
                           -0.2 * along.y * along.z / (flat * length), 0.2 * flat / length};
        return ring_of(middle, w, u);
    });
}

TestMesh star() {
    return turned({{{0.3, 0}, {1, 0.5}, {0.3, 1}, {1.1, 1.5}, {0.3, 2}}}, 9);
}

// D03
TEST(SurfacePieces, CurvedConcaveBodiesAreCutIntoContainedPieces) {
    for (const TestMesh& body :
         {star(), test::torus(2, 0.5, 24, 12), spiral_stair(), trefoil_tube()}) {
        const mesh::Mesh mesh = welded(body);
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
        const mesh::Mesh mesh = welded(box);
        const SurfacePieces pieces = find_surface_pieces(mesh);
        ASSERT_EQ(pieces.pieces.size(), 1U) << thickness;
        EXPECT_TRUE(pieces.pieces[0].contained);
        expect_sound(mesh, pieces);
    }
}

// A plate of a solid that turns back over itself: its hull reaches over the gap.
TEST(SurfacePieces, AGapThinnerThanAnythingIsNotBridged) {
    for (const double gap : {0.25, 0x1p-40}) {
        TestMesh letter = u_prism();  // the notch is 1 <= x <= 2, y >= 1
        for (Double3& p : letter.positions) {
            if (p.x == 2) p.x = 1 + gap;
        }
        const mesh::Mesh mesh = welded(letter);
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
    const SurfacePieces pieces = find_surface_pieces(welded(test::three_sheets()));
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
        const mesh::Mesh mesh =
            welded(test::joined(test::unit_cube(), test::moved_by(test::unit_cube(), 1, shift)));
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
    const mesh::Mesh mesh = welded(test::moebius_strip(16));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::inconsistent)] % 2, 1U);
    for (const SurfacePiece& piece : pieces.pieces) EXPECT_FALSE(piece.contained);
    expect_sound(mesh, pieces);
}

// D06: no side of it can be called its outside, and it crosses itself; every triangle is on
// the hull of its piece all the same.
TEST(SurfacePieces, AKleinBottleIsCutAndContainsNothing) {
    const mesh::Mesh mesh = welded(test::klein_bottle(16, 11));
    for (const PieceOrder order : kOrders) {
        const SurfacePieces pieces = find_surface_pieces(mesh, {.order = order});
        EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::border)], 0U);
        EXPECT_EQ(pieces.edges[static_cast<std::size_t>(EdgeKind::inconsistent)], 11U);
        for (const SurfacePiece& piece : pieces.pieces) EXPECT_FALSE(piece.contained);
        expect_sound(mesh, pieces);
    }
}

// D07: half a sphere is convex, and bounds no solid.
TEST(SurfacePieces, AHemisphereIsOneUncontainedPiece) {
    const mesh::Mesh mesh = welded(test::upper_half(test::icosphere(3)));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    ASSERT_EQ(pieces.pieces.size(), 1U);
    EXPECT_FALSE(pieces.pieces[0].contained);
    EXPECT_GT(pieces.edges[static_cast<std::size_t>(EdgeKind::border)], 0U);
    expect_sound(mesh, pieces);
}

// D08: an inverted cube is reflex everywhere but in its six flat sides.
TEST(SurfacePieces, AnInvertedComponentIsCutIntoItsSides) {
    const mesh::Mesh mesh = welded(test::reversed(test::unit_cube()));
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
    const mesh::Mesh hollow = welded(test::joined(outer, test::reversed(inner)));
    const SurfacePieces around = find_surface_pieces(hollow);
    EXPECT_GT(around.pieces.size(), 8U);
    for (const SurfacePiece& piece : around.pieces) EXPECT_TRUE(piece.contained);
    expect_sound(hollow, around);

    const mesh::Mesh nested = welded(test::joined(outer, inner));
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
        for (const PieceOrder order : kOrders) {
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
        return find_surface_edges(welded(mesh), serial_for).count;
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
    const TestMesh sheet = test::grid_sheet(100, 50);
    const SurfacePieces open = find_surface_pieces(welded(sheet));
    EXPECT_EQ(open.pieces.size(), 1U);

    TestMesh box = test::joined(sheet, test::moved_by(sheet, 1, {0, 0, -1}));
    const std::size_t side = sheet.triangles.size();
    for (std::size_t i = side; i < 2 * side; ++i) {
        std::swap(box.triangles[i].vertex[0], box.triangles[i].vertex[1]);
    }
    const auto below = static_cast<std::uint32_t>(sheet.positions.size());
    const SurfaceEdges edges = find_surface_edges(welded(sheet), serial_for);
    for (mesh::HalfEdge h = 0; h < 3 * side; ++h) {
        if (edges.kind[h] != EdgeKind::border) continue;
        const std::uint32_t a = mesh::start_of(sheet.triangles, h);
        const std::uint32_t b = mesh::end_of(sheet.triangles, h);
        box.triangles.push_back({{b, a, a + below}});
        box.triangles.push_back({{b, a + below, b + below}});
    }
    const mesh::Mesh mesh = welded(box);
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
    const mesh::Mesh whole = welded(mesh);
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

// A step of 1/16 across a bar: with less tolerance it is cut, with more it is not, and
// what is stated is no more than what was allowed and no less than the step.
TEST(SurfacePieces, ToleranceBridgesAStepAndStatesIt) {
    const mesh::Mesh mesh = welded(prism({{{0, 0}, {4, 0}, {4, 1}, {2, 0.9375}, {0, 1}}},
                                         {{{0, 1, 3}, {1, 2, 3}, {0, 3, 4}}}));
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
