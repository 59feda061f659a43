// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/inaccessible/inaccessible.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

#include "query/inaccessible/radial_cover.h"
#include "support/meshes.h"
#include "support/run_threads.h"

namespace cdprep::mesh {
namespace {

using test::TestMesh;

/// Each triangle held against all.
std::vector<std::uint32_t> hidden_by_all(const TestMesh& mesh, const Double3& centre) {
    const RadialCover cover(centre, mesh.positions, mesh.triangles);
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    std::vector<std::uint32_t> hidden;
    for (const std::uint32_t t : all) {
        if (cover.is_hidden(t, all)) hidden.push_back(t);
    }
    return hidden;
}

/// Inside half of a sphere.
TestMesh in_a_shell(const TestMesh& mesh, double radius) {
    TestMesh shell = test::moved_by(test::icosphere(2), radius, {0, 0, 0});
    shell.triangles.resize(shell.triangles.size() / 2);
    return test::joined(shell, mesh);
}

TEST(FindInaccessible, EqualsEachTriangleAgainstAll) {
    const TestMesh soup = in_a_shell(test::random_soup(3, 200, 0.25), 3);
    const TestMesh grid = in_a_shell(test::coarse_grid_soup(4, 200, 3), 6);
    const TestMesh shapes = test::joined(test::torus(1, 0.375, 24, 12),
                                         test::moved_by(test::icosphere(2), 0.25, {1, 0.1, 0}));
    for (const TestMesh& mesh : {soup, grid, shapes}) {
        for (const Double3& centre : {Double3{0, 0, 0}, Double3{0.7, 0.1, -0.05}}) {
            const Inaccessible found = find_inaccessible(centre, mesh.positions, mesh.triangles);
            EXPECT_EQ(found.triangles, hidden_by_all(mesh, centre));
            EXPECT_GT(found.triangles.size(), mesh.triangles.size() / 20);
            EXPECT_LT(found.triangles.size(), mesh.triangles.size() * 9 / 10);
        }
    }
}

TEST(FindInaccessible, IsTheSameForAnyThreads) {
    const TestMesh mesh = test::random_soup(9, 1500, 0.25);
    const Inaccessible one = find_inaccessible({0, 0, 0}, mesh.positions, mesh.triangles);
    const Inaccessible many =
        find_inaccessible({0, 0, 0}, mesh.positions, mesh.triangles, test::run_threads);
    EXPECT_EQ(one.triangles, many.triangles);
    EXPECT_EQ(one.edge_on, many.edge_on);
}

// The sheet's plane holds the centre: inside the closed sphere, it is left out, not hidden;
// and it hides nothing itself.
TEST(FindInaccessible, CountsWhatLiesEdgeOn) {
    const TestMesh sheet = test::moved_by(test::grid_sheet(3, 3), 0.125, {0.125, 0.125, 0});
    TestMesh mesh = test::joined(test::icosphere(1), sheet);
    const Inaccessible found = find_inaccessible({0, 0, 0}, mesh.positions, mesh.triangles);
    EXPECT_EQ(found.edge_on, 18U);
    EXPECT_TRUE(found.triangles.empty());
    // A hair out of the plane, nothing is edge-on, and all of it is hidden.
    const Inaccessible beside = find_inaccessible({0, 0, 1e-300}, mesh.positions, mesh.triangles);
    EXPECT_EQ(beside.edge_on, 0U);
    EXPECT_EQ(beside.triangles.size(), 18U);
}

// Points, segments, and triangles with a corner at the centre.
TEST(FindInaccessible, DegenerateTrianglesLieEdgeOn) {
    TestMesh mesh = test::icosphere(0);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(),
                          {{0, 0, 0}, {0.25, 0, 0.125}, {0.375, 0.1, 0.25}, {0.5, 0, 0.25}});
    mesh.triangles.insert(mesh.triangles.end(), {{{first + 1, first + 1, first + 1}},
                                                 {{first + 1, first + 2, first + 2}},
                                                 {{first, first + 1, first + 2}},
                                                 {{first + 1, first + 2, first + 3}}});
    const Inaccessible found = find_inaccessible({0, 0, 0}, mesh.positions, mesh.triangles);
    EXPECT_EQ(found.edge_on, 4U);
    EXPECT_TRUE(found.triangles.empty());
}

TEST(FindInaccessible, NothingOfNothing) {
    EXPECT_TRUE(find_inaccessible({0, 0, 0}, {}, {}).triangles.empty());
}

}  // namespace
}  // namespace cdprep::mesh
