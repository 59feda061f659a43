// SPDX-License-Identifier: MIT
// What is sought when the search for cells is timed.
#include "cell_searches/search_contenders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "support/meshes.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study::search {
namespace {

/// The triangle with corners at 0, 1 and 1 along x and y, and one of three times its area.
mesh::Mesh two_triangles() {
    return test::mesh_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 0, 5}, {12, 0, 5}, {9, 1, 5}},
                          {{{0, 1, 2}}, {{3, 4, 5}}}});
}

// By hand: a quarter of the area is below, and the mean of evenly spread points of a triangle is
// its centre. Of 20,000 points the mean is off by 0.002, and four times as much is rare.
TEST(SurfaceSet, SpreadsPointsEvenlyOverTheArea) {
    Random random(3);
    const std::vector<Double3> points = surface_set(two_triangles(), 20'000, random).points;
    double below = 0, x = 0, y = 0;
    for (const Double3& p : points) {
        ASSERT_TRUE(p.z == 0 || p.z == 5);
        const double u = p.z == 0 ? p.x : (p.x - 9) / 3;
        EXPECT_GE(u, 0);
        EXPECT_GE(p.y, 0);
        EXPECT_LE(u + p.y, 1 + 1e-12);
        x += u;
        y += p.y;
        below += p.z == 0 ? 1 : 0;
    }
    const auto count = static_cast<double>(points.size());
    EXPECT_NEAR(x / count, 1.0 / 3, 0.008);
    EXPECT_NEAR(y / count, 1.0 / 3, 0.008);
    EXPECT_NEAR(below / count, 0.25, 0.015);
}

TEST(UniformSet, FillsTheRootToItsEnds) {
    Random random(3);
    format::OctreeGrid grid{};
    grid.origin = {-1, 2, 30};
    grid.step = 0x1p-20;  // the root's side is 2
    Double3 low = {9, 9, 99}, high = {-9, -9, -99};
    for (const Double3& p : uniform_set(grid, 20'000, random).points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    for (const auto& [axis, from] :
         {std::pair(&Double3::x, -1.0), {&Double3::y, 2.0}, {&Double3::z, 30.0}}) {
        EXPECT_GE(low.*axis, from);
        EXPECT_LE(high.*axis, from + 2);
        EXPECT_LT(low.*axis, from + 0.001);
        EXPECT_GT(high.*axis, from + 1.999);
    }
}

// By hand: each face of a tetrahedron has the three others across, and a sheet's border itself.
TEST(Neighbours, AreAcrossTheEdges) {
    const auto solid =
        neighbours(test::mesh_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                  {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}}}));
    for (std::uint32_t t = 0; t < 4; ++t) {
        std::array<std::uint32_t, 3> sorted = solid[t];
        std::ranges::sort(sorted);
        std::array<std::uint32_t, 3> others{};
        for (std::uint32_t i = 0, k = 0; i < 4; ++i) {
            if (i != t) others[k++] = i;
        }
        EXPECT_EQ(sorted, others);
    }
    const auto sheet = neighbours(
        test::mesh_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{{0, 1, 2}}, {{2, 1, 3}}}}));
    EXPECT_EQ(sheet[0], (std::array<std::uint32_t, 3>{0, 1, 0}));
    EXPECT_EQ(sheet[1], (std::array<std::uint32_t, 3>{0, 1, 1}));
}

/// The triangle of a mesh that a point lies on.
std::uint32_t triangle_at(const mesh::Mesh& mesh, const Double3& p) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<Double3, 3> at = corners_of(mesh, t);
        const double whole = area(at);
        const double parts =
            area({p, at[1], at[2]}) + area({at[0], p, at[2]}) + area({at[0], at[1], p});
        if (parts < whole * (1 + 1e-7)) return t;
    }
    return 99;
}

// Each point is on a neighbour of the triangle before, and seldom on the one before that.
TEST(WalkSet, GoesFromTriangleToTriangleAcrossEdges) {
    Random random(3);
    const mesh::Mesh ball = test::mesh_of(test::icosphere(1));
    const auto across = neighbours(ball);
    const std::vector<Double3> points = walk_set(ball, 600, random).points;
    ASSERT_EQ(points.size(), 600U);
    std::vector<std::uint32_t> on;
    for (const Double3& p : points) {
        on.push_back(triangle_at(ball, p));
        ASSERT_LT(on.back(), ball.triangles.size());
    }
    std::size_t back = 0;
    for (std::size_t i = 1; i < on.size(); ++i) {
        const auto& near = across[on[i - 1]];
        EXPECT_NE(std::find(near.begin(), near.end(), on[i]), near.end()) << i;
        back += i > 1 && on[i] == on[i - 2] ? 1 : 0;
    }
    EXPECT_EQ(back, 0U);
    std::ranges::sort(on);
    on.erase(std::unique(on.begin(), on.end()), on.end());
    EXPECT_GT(on.size(), 30U);  // of 80: it changes its direction
}

// std::upper_bound counts as well, with branches.
TEST(CountWithoutBranch, IsThatOfABinarySearch) {
    for (std::size_t size = 0; size < 70; ++size) {
        std::vector<std::uint64_t> codes;
        for (std::size_t i = 0; i < size; ++i) codes.push_back(3 * i + 1);
        for (std::uint64_t code = 0; code < 3 * size + 3; ++code) {
            const auto count = std::upper_bound(codes.begin(), codes.end(), code) - codes.begin();
            ASSERT_EQ(count_without_branch(codes, code), static_cast<std::size_t>(count))
                << size << " " << code;
        }
    }
}

}  // namespace
}  // namespace cdprep::study::search
