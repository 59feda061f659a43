// SPDX-License-Identifier: MIT
#include "decompose/surface/piece_arrays.h"

#include <gtest/gtest.h>

#include "mesh/weld.h"
#include "support/meshes.h"
#include "support/run_threads.h"
#include "unit/tools/pieces_flaw.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using format::facet_first_of_face;
using format::facet_virtual;

PieceArrays piece_arrays_of(const mesh::Mesh& mesh, const SurfacePieceOptions& options = {}) {
    return make_piece_arrays(mesh, find_surface_pieces(mesh, options), serial_for);
}

std::size_t count_flag(const PieceArrays& arrays, std::uint32_t flag) {
    return static_cast<std::size_t>(
        std::count_if(arrays.facets.begin(), arrays.facets.end(),
                      [&](const format::PieceFacet& facet) { return (facet.flags & flag) != 0; }));
}

TEST(PieceArrays, ACubeIsItsOwnHullWithoutVirtualFaces) {
    const PieceArrays arrays = piece_arrays_of(test::welded(test::unit_cube()));
    ASSERT_EQ(arrays.pieces.size(), 1U);
    EXPECT_EQ(arrays.pieces[0].dimension, 3U);
    EXPECT_EQ(arrays.pieces[0].flags, format::piece_contained);
    EXPECT_EQ(arrays.vertices.size(), 8U);
    EXPECT_EQ(arrays.facets.size(), 12U);
    EXPECT_EQ(count_flag(arrays, facet_virtual), 0U);
    EXPECT_EQ(count_flag(arrays, facet_first_of_face), 6U);
}

// D01: what is convex is one piece and its own hull; of a lattice's sphere many faces have
// more than three corners.
TEST(PieceArrays, AConvexBodyHasNoVirtualFaces) {
    std::vector<Double3> points = test::lattice_sphere(1155);
    points.resize(10'000);
    const ConvexHull hull = convex_hull(points);
    test::TestMesh round;
    round.positions = hull.points;
    for (const auto& facet : hull.facets) round.triangles.push_back({facet});
    test::TestMesh box = test::unit_cube();
    for (Double3& p : box.positions) p = {3 * p.x, p.y, 0.125 * p.z};
    for (const test::TestMesh& body : {round, box, test::icosphere(4)}) {
        const PieceArrays arrays = piece_arrays_of(test::welded(body));
        ASSERT_EQ(arrays.pieces.size(), 1U);
        EXPECT_EQ(arrays.pieces[0].flags, format::piece_contained);
        EXPECT_EQ(arrays.pieces[0].outer_error, 0);
        EXPECT_EQ(arrays.vertices.size(), body.positions.size());
        EXPECT_EQ(arrays.facets.size(), body.triangles.size());
        EXPECT_EQ(count_flag(arrays, facet_virtual), 0U);
    }
}

// By hand: without two of its triangles, which are the top, the cube is open there. Without
// one, the top is covered by half: virtual too.
TEST(PieceArrays, AFaceThatTrianglesDoNotFillIsVirtual) {
    for (const std::size_t missing : {1U, 2U}) {
        test::TestMesh cube = test::unit_cube();
        std::size_t gone = 0;
        std::erase_if(cube.triangles, [&](const format::Triangle& t) {
            const bool is_top = std::all_of(t.vertex.begin(), t.vertex.end(), [&](std::uint32_t v) {
                return cube.positions[v].z == 1;
            });
            return is_top && gone++ < missing;
        });
        const PieceArrays arrays = piece_arrays_of(test::welded(cube));
        ASSERT_EQ(arrays.pieces.size(), 1U);
        EXPECT_EQ(arrays.pieces[0].flags, 0U);
        EXPECT_EQ(count_flag(arrays, facet_virtual), 2U);
    }
}

// A flat piece has two faces, and only the one that it is wound like is covered.
TEST(PieceArrays, ASheetHasABack) {
    const PieceArrays arrays = piece_arrays_of(test::welded(test::grid_sheet(3, 2)));
    ASSERT_EQ(arrays.pieces.size(), 1U);
    EXPECT_EQ(arrays.pieces[0].dimension, 2U);
    EXPECT_EQ(arrays.vertices.size(), 4U);
    EXPECT_EQ(arrays.facets.size(), 4U);
    EXPECT_EQ(count_flag(arrays, facet_virtual), 2U);
    EXPECT_EQ(count_flag(arrays, facet_first_of_face), 2U);
}

TEST(PieceArrays, ATriangleWithoutAreaIsASegment) {
    test::TestMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    mesh.triangles = {{{0, 1, 2}}};
    const PieceArrays arrays = piece_arrays_of(test::welded(mesh));
    ASSERT_EQ(arrays.pieces.size(), 1U);
    EXPECT_EQ(arrays.pieces[0].dimension, 1U);
    EXPECT_EQ(arrays.vertices, (std::vector<std::uint32_t>{0, 2}));
    EXPECT_TRUE(arrays.facets.empty());
}

// Every triangle of a piece lies in one face of its hull, which is virtual only when there
// is more of it; threads change nothing.
TEST(PieceArrays, FacesHoldTheTriangles) {
    const mesh::Mesh mesh = test::welded(test::torus(2, 0.5, 24, 12));
    const SurfacePieces pieces = find_surface_pieces(mesh);
    const PieceArrays arrays = make_piece_arrays(mesh, pieces, serial_for);
    const PieceArrays together = make_piece_arrays(mesh, pieces, test::run_threads);
    EXPECT_EQ(arrays.vertices, together.vertices);
    EXPECT_EQ(arrays.facets.size(), together.facets.size());
    EXPECT_GT(count_flag(arrays, facet_virtual), 0U);
    EXPECT_LT(count_flag(arrays, facet_virtual), arrays.facets.size());
    for (std::size_t i = 0; i < arrays.pieces.size(); ++i) {
        const bool last = i + 1 == arrays.pieces.size();
        const std::size_t end = last ? arrays.facets.size() : arrays.pieces[i + 1].first_facet;
        for (const std::uint32_t t : pieces.of(i)) {
            const auto& v = mesh.triangles[t].vertex;
            const test::ExactPlane plane =
                test::exact_plane(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]);
            bool found = false;
            for (std::size_t f = arrays.pieces[i].first_facet; f < end; ++f) {
                const auto& c = arrays.facets[f].corner;
                found = found || std::all_of(c.begin(), c.end(), [&](std::uint32_t corner) {
                            const std::size_t at = arrays.pieces[i].first_vertex + corner;
                            return plane.side(mesh.positions[arrays.vertices[at]]) == 0;
                        });
            }
            EXPECT_TRUE(found);
        }
    }
}

}  // namespace
}  // namespace cdprep::convex
