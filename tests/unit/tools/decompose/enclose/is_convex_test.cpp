// SPDX-License-Identifier: MIT
#include "decompose/enclose/is_convex.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "mesh/exact_volume.h"
#include "support/concave_solids.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using mesh::Mesh;
using test::mesh_of;
using test::TestMesh;

bool is_convex(const TestMesh& test_mesh) {
    const Mesh mesh = mesh_of(test_mesh);
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    return is_convex(mesh, all, convex_hull(mesh.positions));
}

TestMesh box(const Double3& low, const Double3& high) {
    TestMesh mesh = test::unit_cube();
    for (Double3& p : mesh.positions) {
        p = {p.x == 0 ? low.x : high.x, p.y == 0 ? low.y : high.y, p.z == 0 ? low.z : high.z};
    }
    return mesh;
}

double volume_of(const TestMesh& mesh) {
    mesh::ExactVolume sum;
    for (const auto& t : mesh.triangles) {
        sum.add(mesh.positions[t.vertex[0]], mesh.positions[t.vertex[1]],
                mesh.positions[t.vertex[2]]);
    }
    return sum.volume();
}

double volume_of(const ConvexHull& hull) {
    TestMesh mesh;
    mesh.positions = hull.points;
    for (const auto& f : hull.facets) mesh.triangles.push_back({f});
    return volume_of(mesh);
}

// Every body is convex, by hand.
TEST(IsConvex, ConvexBodiesAre) {
    for (const TestMesh& body :
         {test::unit_cube(), test::icosphere(0), test::icosphere(3),
          test::box_with_a_fine_side(7, 5), box({-3, 0, 1}, {1e-9, 1e9, 2})}) {
        EXPECT_TRUE(is_convex(body));
        EXPECT_TRUE(is_convex(test::reversed(body)));
    }
}

TEST(IsConvex, ConcaveBodiesAreNot) {
    for (const TestMesh& body : {test::l_prism(), test::plus_prism(), test::star(),
                                 test::torus(2, 0.5, 12, 8), test::spiral_stair()}) {
        EXPECT_FALSE(is_convex(body));
    }
}

// A side is cut at a vertex in the middle of an edge. A triangle without area fills the slit.
TEST(IsConvex, ABodyWithTrianglesWithoutAreaIs) {
    TestMesh mesh = test::unit_cube();
    const auto [a, b, c] = mesh.triangles[0].vertex;
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
    const Double3 &p = mesh.positions[a], &q = mesh.positions[b];
    mesh.positions.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
    mesh.triangles[0] = {{a, middle, c}};
    mesh.triangles.push_back({{middle, b, c}});
    mesh.triangles.push_back({{a, b, middle}});
    EXPECT_TRUE(is_convex(mesh));
}

// Two boxes of volumes 2 and 3 cross. Their hull, an octagon, has 5: 2 x 3 less four triangles of
// 1/4.
TEST(IsConvex, CrossingBoxesWithTheVolumeOfTheirHullAreNot) {
    const TestMesh cross =
        test::joined(box({-1, -0.5, 0}, {1, 0.5, 1}), box({-0.5, -1.5, 0}, {0.5, 1.5, 1}));
    ASSERT_EQ(volume_of(cross), volume_of(convex_hull(cross.positions)));
    EXPECT_FALSE(is_convex(cross));
}

/// A closed surface over a polygon that goes around its middle twice, with an apex on either side.
/// All edges are convex. The polygon's own order is that of its hull.
TestMesh double_star(const std::vector<Double3>& polygon, const Double3& up, const Double3& down) {
    TestMesh mesh;
    mesh.positions = polygon;
    mesh.positions.push_back(up);
    mesh.positions.push_back(down);
    const auto count = static_cast<std::uint32_t>(polygon.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 2) % count;
        mesh.triangles.push_back({{i, next, count}});
        mesh.triangles.push_back({{next, i, count + 1}});
    }
    return mesh;
}

// Twice the area of the heptagon is 105. So is that of its star, whose middle counts twice.
TEST(IsConvex, AStarWithConvexEdgesAndTheVolumeOfItsHullIsNot) {
    const TestMesh star = double_star(
        {{0, 0, 0}, {-5, -8, 0}, {-4, -12, 0}, {0, -9, 0}, {2, -6, 0}, {3, -4, 0}, {4, -1, 0}},
        {0, -6, 3}, {0, -6, -3});
    ASSERT_EQ(volume_of(star), volume_of(convex_hull(star.positions)));
    EXPECT_FALSE(is_convex(star));
}

// The hull itself is the oracle: its facets are convex, and any vertex moved inwards ends that.
TEST(IsConvexLaws, HullsAreAndDentedHullsAreNot) {
    std::mt19937 random(11);
    std::uniform_int_distribution<int> place(-4, 4);
    int dented = 0;
    for (int round = 0; round < 200; ++round) {
        std::vector<Double3> points(12);
        for (Double3& p : points) {
            p.x = place(random);
            p.y = place(random);
            p.z = place(random);
        }
        const ConvexHull hull = convex_hull(points);
        if (hull.dimension != 3) continue;
        TestMesh mesh;
        mesh.positions = hull.points;
        for (const auto& f : hull.facets) mesh.triangles.push_back({f});
        EXPECT_TRUE(is_convex(mesh)) << round;
        Double3& p = mesh.positions[0];
        Double3 middle = {0, 0, 0};
        for (const Double3& q : hull.points) {
            const auto share = 1.0 / static_cast<double>(hull.points.size());
            middle = {middle.x + share * q.x, middle.y + share * q.y, middle.z + share * q.z};
        }
        p = {0.25 * p.x + 0.75 * middle.x, 0.25 * p.y + 0.75 * middle.y,
             0.25 * p.z + 0.75 * middle.z};
        // A vertex is no longer a corner of the hull, but the surface reaches the old neighbours.
        if (convex_hull(mesh.positions).points.size() == hull.points.size()) continue;
        ++dented;
        EXPECT_FALSE(is_convex(mesh)) << round;
    }
    EXPECT_GT(dented, 50);
}

}  // namespace
}  // namespace cdprep::convex
