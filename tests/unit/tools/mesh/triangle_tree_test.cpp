// SPDX-License-Identifier: MIT
#include "mesh/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/meshes.h"

#include "exact/point_triangle_distance.h"

namespace cdprep::convex {
namespace {

using test::TestMesh;

TriangleTree tree_of(const TestMesh& mesh) {
    return {mesh.positions, mesh.triangles, serial_for};
}

mesh::Box box_of(const TestMesh& mesh) {
    mesh::Box box;
    for (const Double3& p : mesh.positions) box.add(p);
    return box;
}

/// Points in a box three times as large, and some that are corners.
std::vector<Double3> points_around(const TestMesh& mesh, std::size_t count) {
    std::mt19937 random(20261122);
    const mesh::Box box = box_of(mesh);
    std::vector<Double3> points;
    const auto at = [&](double lower, double upper) {
        const double size = upper - lower;
        return std::uniform_real_distribution<double>(lower - size, upper + size)(random);
    };
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back({at(box.lower.x, box.upper.x), at(box.lower.y, box.upper.y),
                          at(box.lower.z, box.upper.z)});
    }
    for (std::size_t i = 0; i < std::min(count, mesh.positions.size()); ++i) {
        points.push_back(mesh.positions[i]);
    }
    return points;
}

/// Meshes whose numbers are large, small, far from 0, of one plane, one triangle, one point.
std::vector<TestMesh> meshes() {
    const TestMesh ring = test::torus(1, 0.3, 40, 20);
    return {ring,
            test::moved_by(ring, 1e60, {0, 0, 0}),
            test::moved_by(ring, 1e-60, {0, 0, 0}),
            test::moved_by(ring, 1, {1e8, -1e9, 1e7}),
            test::random_soup(7, 900, 0.2),
            test::coarse_grid_soup(3, 500, 3),
            test::grid_sheet(9, 7),
            test::fan(1),
            test::copies_of_one_triangle(70),
            {{{2, 3, 4}}, {{{0, 0, 0}}}}};
}

// Against every triangle: none is nearer than the one that is named, by more than rounding.
TEST(TriangleTree, NamesTheNearestTriangle) {
    for (const TestMesh& mesh : meshes()) {
        const TriangleTree tree = tree_of(mesh);
        const double slack =
            1e-12 * (box_of(mesh).diagonal() + std::abs(mesh.positions[0].x) +
                     std::abs(mesh.positions[0].y) + std::abs(mesh.positions[0].z));
        for (const Double3& p : points_around(mesh, 150)) {
            double least = std::numeric_limits<double>::infinity();
            for (std::uint32_t i = 0; i < tree.size(); ++i) {
                least = std::min(least, point_triangle_distance(p, tree.corners(i)).upper);
            }
            const TriangleTree::Nearest near = tree.nearest(p);
            EXPECT_NEAR(near.distance, least, slack);
            EXPECT_LE(point_triangle_distance(p, tree.corners(near.triangle)).lower, least + slack);
        }
    }
}

// From the middle of a ball all of its triangles are about as near: none can be left out, and
// looks say so. From beside one they are few.
TEST(TriangleTree, CountsWhatItLooksAt) {
    const TestMesh ball = test::icosphere(4);
    const TriangleTree tree = tree_of(ball);
    ASSERT_EQ(tree.size(), 5120U);
    const TriangleTree::Nearest from_middle = tree.nearest({0, 0, 0});
    EXPECT_GE(from_middle.looks, tree.size() / 8);  // each leaf, at least
    EXPECT_GE(from_middle.weight(), 10U);
    const TriangleTree::Nearest from_beside = tree.nearest({1.001, 0, 0});
    EXPECT_GT(from_beside.looks, 3U);
    EXPECT_LT(from_beside.looks, 200U);
    EXPECT_EQ(from_beside.weight(), 1U);
}

// To the last bit: what is stored of a field may not depend on who asked before.
TEST(TriangleTree, FindsTheSameDistanceFromAnyHint) {
    for (const TestMesh& mesh : meshes()) {
        const TriangleTree tree = tree_of(mesh);
        const auto count = static_cast<std::uint32_t>(tree.size());
        for (const Double3& p : points_around(mesh, 100)) {
            const double distance = tree.nearest(p).distance;
            for (const std::uint32_t hint : {0U, count / 3, count - 1, count}) {
                EXPECT_EQ(tree.nearest(p, hint).distance, distance);
            }
        }
    }
}

std::vector<std::uint32_t> met_by(const TestMesh& mesh, const mesh::Box& wanted) {
    std::vector<std::uint32_t> met;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        mesh::Box box;
        for (const std::uint32_t v : mesh.triangles[i].vertex) box.add(mesh.positions[v]);
        if (box.meets(wanted)) met.push_back(i);
    }
    return met;
}

// The same sets as all boxes tested one by one, touching ones too: corners of the mesh are
// among the points.
TEST(TriangleTree, VisitsWhatBoxesAndRaysMeet) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::size_t most = 0;
    for (const TestMesh& mesh : meshes()) {
        const TriangleTree tree = tree_of(mesh);
        const auto sorted = [](std::vector<std::uint32_t> numbers) {
            std::sort(numbers.begin(), numbers.end());
            return numbers;
        };
        const std::vector<Double3> points = points_around(mesh, 100);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Double3& p = points[i];
            std::vector<std::uint32_t> visited;
            const auto visit = [&](std::uint32_t triangle) { visited.push_back(triangle); };
            tree.along_x(p, visit);
            EXPECT_EQ(sorted(visited), met_by(mesh, {p, {kFar, p.y, p.z}}));
            mesh::Box box;
            box.add(p);
            box.add(points[(i * 7 + 1) % points.size()]);
            visited.clear();
            tree.in_box(box, visit);
            EXPECT_EQ(sorted(visited), met_by(mesh, box));
            most = std::max(most, visited.size());
        }
    }
    EXPECT_GT(most, 500u);
}

// A mesh of any size is a point from so far away.
TEST(TriangleTree, FindsTheDistanceFromFarBeyondTheMesh) {
    for (const double size : {1e-320, 1e-300, 1e-100, 1e-30}) {
        const TriangleTree tree = tree_of(test::moved_by(test::icosphere(2), size, {0, 0, 0}));
        for (const Double3& p : {Double3{2, 3, 6}, Double3{-2, 6, -3}, Double3{0, 0, 7}}) {
            EXPECT_NEAR(tree.nearest(p).distance, 7, 1e-12) << size;
        }
    }
}

}  // namespace
}  // namespace cdprep::convex
