// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "decompose/surface/surface_pieces.h"
#include "mesh/weld.h"
#include "support/meshes.h"
#include "support/run_threads.h"
#include "unit/tools/pieces_flaw.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

/// A sphere with dents and bumps: about half of its edges are reflex.
mesh::Mesh bumpy_ball(int level, double size, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> factor(1 - size, 1 + size);
    test::TestMesh ball = test::icosphere(level);
    for (Double3& p : ball.positions) {
        const double f = factor(random);
        p = {f * p.x, f * p.y, f * p.z};
    }
    return test::welded(ball);
}

void expect_equal(const SurfacePieces& a, const SurfacePieces& b) {
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.first, b.first);
    for (std::size_t i = 0; i < a.pieces.size(); ++i) {
        EXPECT_EQ(a.pieces[i].contained, b.pieces[i].contained);
        EXPECT_EQ(a.pieces[i].outer_error, b.pieces[i].outer_error);
    }
}

TEST(SurfacePiecesLaws, SolidsAreCutIntoContainedPieces) {
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
        const mesh::Mesh mesh = bumpy_ball(2, 0.02 + 0.2 * seed, seed);
        for (const PieceOrder order : test::kPieceOrders) {
            const SurfacePieces pieces = find_surface_pieces(mesh, {.order = order});
            EXPECT_EQ(test::partition_flaw(mesh, pieces), "") << seed;
            EXPECT_EQ(test::hull_face_flaw(mesh, pieces), "") << seed;
            EXPECT_EQ(test::containment_flaw(mesh, pieces), "") << seed;
            EXPECT_GT(pieces.pieces.size(), 1U);
            EXPECT_LT(pieces.pieces.size(), mesh.triangles.size());
            for (const SurfacePiece& piece : pieces.pieces) EXPECT_TRUE(piece.contained);
        }
    }
}

// Soups on a coarse grid have every kind of edge; nothing else is known of them.
TEST(SurfacePiecesLaws, SoupsArePartitioned) {
    std::array<std::size_t, kEdgeKinds> met{};
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        const mesh::Mesh mesh = test::welded(test::coarse_grid_soup(seed, 400, 1 + seed % 3));
        for (const double tolerance : {0.0, 0.5}) {
            for (const PieceOrder order : test::kPieceOrders) {
                const SurfacePieces pieces =
                    find_surface_pieces(mesh, {.order = order, .tolerance = tolerance});
                EXPECT_EQ(test::partition_flaw(mesh, pieces), "") << seed;
                if (tolerance == 0) {
                    EXPECT_EQ(test::hull_face_flaw(mesh, pieces), "") << seed;
                }
                for (std::size_t i = 0; i < kEdgeKinds; ++i) met[i] += pieces.edges[i];
            }
        }
    }
    EXPECT_GT(met[static_cast<std::size_t>(EdgeKind::non_manifold)], 0U);
    EXPECT_GT(met[static_cast<std::size_t>(EdgeKind::inconsistent)], 0U);
    EXPECT_GT(met[static_cast<std::size_t>(EdgeKind::no_area)], 0U);
    EXPECT_GT(met[static_cast<std::size_t>(EdgeKind::convex)], 0U);
}

TEST(SurfacePiecesLaws, ThreadsChangeNothing) {
    const mesh::Mesh mesh = bumpy_ball(5, 0.003, 1);  // 20480 triangles: several parts
    for (const double tolerance : {0.0, 0.01}) {
        const SurfacePieces alone = find_surface_pieces(mesh, {.tolerance = tolerance});
        const SurfacePieces together =
            find_surface_pieces(mesh, {.tolerance = tolerance, .parallel_for = test::run_threads});
        expect_equal(alone, together);
    }
}

// A sheet rolled up more than once, of flat strips: many lie in two parts, and whoever merges
// over their edges must have them to himself.
TEST(SurfacePiecesLaws, ThreadsChangeNothingAtPolygonsInSeveralParts) {
    test::TestMesh roll = test::grid_sheet(800, 25);
    for (Double3& p : roll.positions) {
        const double angle = 0.02 * p.x, radius = 1 + 0.0002 * p.x;
        p = {radius * std::cos(angle), radius * std::sin(angle), 0.01 * p.y};
    }
    const mesh::Mesh mesh = test::welded(roll);
    const SurfacePieces alone = find_surface_pieces(mesh);
    EXPECT_GT(alone.pieces.size(), 1U);
    EXPECT_LT(alone.pieces.size(), 20U);
    const auto backwards = [](std::size_t count, Task task) {
        while (count > 0) task(--count);
    };
    expect_equal(alone, find_surface_pieces(mesh, {.parallel_for = backwards}));
    for (int i = 0; i < 10; ++i) {
        expect_equal(alone, find_surface_pieces(mesh, {.parallel_for = test::run_threads}));
    }
}

/// How far the vertices of a piece are above the planes of its triangles, in long double,
/// whose rounding is 2^-11 of that of double.
long double measured_error(const mesh::Mesh& mesh, std::span<const std::uint32_t> piece) {
    long double most = 0;
    const std::vector<Double3> points = test::piece_points(mesh, piece);
    for (const std::uint32_t t : piece) {
        const auto& v = mesh.triangles[t].vertex;
        const Double3 &a = mesh.positions[v[0]], &b = mesh.positions[v[1]],
                      &c = mesh.positions[v[2]];
        const long double ux = static_cast<long double>(b.x) - a.x,
                          uy = static_cast<long double>(b.y) - a.y,
                          uz = static_cast<long double>(b.z) - a.z;
        const long double wx = static_cast<long double>(c.x) - a.x,
                          wy = static_cast<long double>(c.y) - a.y,
                          wz = static_cast<long double>(c.z) - a.z;
        const long double nx = uy * wz - uz * wy, ny = uz * wx - ux * wz, nz = ux * wy - uy * wx;
        const long double length = std::sqrt(nx * nx + ny * ny + nz * nz);
        for (const Double3& p : points) {
            const long double height = nx * (p.x - static_cast<long double>(a.x)) +
                                       ny * (p.y - static_cast<long double>(a.y)) +
                                       nz * (p.z - static_cast<long double>(a.z));
            most = std::max(most, height / length);
        }
    }
    return most;
}

TEST(SurfacePiecesLaws, StatedErrorsHoldAndAreWithinTheTolerance) {
    std::size_t last = SIZE_MAX, with_error = 0;
    for (const double tolerance : {0.0, 0.002, 0.01, 4.0}) {
        const mesh::Mesh mesh = bumpy_ball(4, 0.01, 3);
        const SurfacePieces pieces = find_surface_pieces(mesh, {.tolerance = tolerance});
        EXPECT_EQ(test::partition_flaw(mesh, pieces), "");
        for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
            const double stated = pieces.pieces[i].outer_error;
            EXPECT_LE(stated, tolerance);
            EXPECT_GE(stated, measured_error(mesh, pieces.of(i)) - 1e-17L);
            EXPECT_LE(stated, measured_error(mesh, pieces.of(i)) + 1e-12L);
            with_error += stated > 0 ? 1 : 0;
        }
        EXPECT_LT(pieces.pieces.size(), last);
        last = pieces.pieces.size();
    }
    EXPECT_EQ(last, 1U);
    EXPECT_GT(with_error, 0U);
}

}  // namespace
}  // namespace cdprep::convex
