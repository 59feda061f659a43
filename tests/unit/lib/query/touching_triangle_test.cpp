// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "exact/triangle_contact.h"
#include "support/touched.h"

namespace cdprep::test {
namespace {

/// Corners (0, 0, 0), (4, 0, 0), (0, 4, 0).
bool hits(const Double3& a, const Double3& b, const Double3& c) {
    return !touched(right_triangle(), TriangleShape{{{a, b, c}}}).empty();
}

// By hand: crossing, an edge in common, a corner in common, in one plane, just beside.
TEST(TouchingTriangle, TouchingCounts) {
    EXPECT_TRUE(hits({1, 1, -1}, {1, 1, 1}, {2, 2, 1}));
    EXPECT_TRUE(hits({0, 0, 0}, {4, 0, 0}, {0, 0, 4}));
    EXPECT_TRUE(hits({4, 0, 0}, {5, 0, 1}, {5, 1, 1}));
    EXPECT_FALSE(hits({std::nextafter(4.0, 5.0), 0, 0}, {5, 0, 1}, {5, 1, 1}));
    EXPECT_TRUE(hits({1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}));
    EXPECT_TRUE(hits({2, 2, 0}, {9, 9, 0}, {9, 8, 0}));
    EXPECT_FALSE(hits({2, std::nextafter(2.0, 3.0), 0}, {9, 9, 0}, {9, 8, 0}));
    EXPECT_FALSE(hits({1, 1, 0x1p-1074}, {1.5, 1, 1}, {1, 1.5, 1}));
}

TEST(TouchingTriangle, WithoutAreaItIsASegmentOrAPoint) {
    EXPECT_TRUE(hits({1, 1, -1}, {1, 1, 1}, {1, 1, 0.5}));
    EXPECT_FALSE(hits({3, 3, -1}, {3, 3, 1}, {3, 3, 0.5}));
    EXPECT_TRUE(hits({2, 2, 0}, {2, 2, 0}, {2, 2, 0}));
    EXPECT_FALSE(hits({2, 2, 1}, {2, 2, 1}, {2, 2, 1}));
    EXPECT_TRUE(touched({}, TriangleShape{}).empty());
}

// By hand: one above the sheet, nearest to the lowest number of several.
TEST(TouchingTriangle, DistanceTakesTheLowestOfTheNearest) {
    const OpenModel model = open_tiny(copies_of_one_triangle(20));
    Workspace workspace;
    const TriangleShape far = {{{{90, 0, 0}, {91, 0, 0}, {90, 1, 5}}}};
    const auto found = shape_distance(model.model, far, workspace);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->triangle, 0u);
    EXPECT_EQ(found->on_shape, (Double3{90, 0, 0}));
    const OpenModel empty = open_tiny(TestMesh{});
    EXPECT_FALSE(shape_distance(empty.model, far, workspace));
    EXPECT_FALSE(shape_distance(model.model, far, workspace, {.max_distance = -1}));
}

// The oracle: each triangle alone. Products of three coordinates are beyond the largest double.
TEST(TouchingTriangle, CubesBeyondDoubleHideNothing) {
    const TestMesh mesh{{{-1, -1, -1}, {1, 1, 1}, {1, -1, 0.25}, {0.75, 1, -1}},
                        {{{0, 1, 2}}, {{1, 2, 3}}}};
    std::mt19937 random(20261129);
    std::uniform_real_distribution<double> place(-1, 1);
    int touching = 0;
    for (int round = 0; round < 2000; ++round) {
        const double size = std::ldexp(1.0, 330 + round % 20);
        const auto corner = [&] {
            const double x = place(random), y = place(random), z = place(random);
            return Double3{size * x, size * y, size * z};
        };
        const Double3 a = corner(), b = corner();
        const Double3 c = {-(a.x + b.x), -(a.y + b.y), -(a.z + b.z)};  // around the model
        const TriangleShape shape = {{{a, b, c}}};
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto& [u, v, w] = mesh.triangles[i].vertex;
            if (triangles_touch(shape.corner,
                                {mesh.positions[u], mesh.positions[v], mesh.positions[w]})) {
                expected.push_back(i);
            }
        }
        touching += expected.empty() ? 0 : 1;
        ASSERT_EQ(touched(mesh, shape), expected) << "seed 20261129, round " << round;
    }
    EXPECT_GT(touching, 100);
}

}  // namespace
}  // namespace cdprep::test
