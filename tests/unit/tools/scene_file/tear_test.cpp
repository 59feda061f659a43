// SPDX-License-Identifier: MIT
#include "scene_file/tear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "support/exact_rational.h"
#include "support/meshes.h"

namespace cdprep::scenes {
namespace {

using test::ExactNumber;
using test::TestMesh;

std::vector<LiveTriangle> numbered(const TestMesh& mesh) {
    std::vector<LiveTriangle> triangles;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        triangles.push_back({i, mesh.triangles[i].vertex});
    }
    return triangles;
}

Cut cut_mesh(const TestMesh& mesh, const Tear& tear) {
    return cut_by_plane(mesh.positions, numbered(mesh), tear);
}

/// Returns the mesh after a cut that removes and appends.
TestMesh after_cut(const TestMesh& mesh, const Cut& cut) {
    TestMesh after = {mesh.positions, {}};
    for (const CutVertex& vertex : cut.vertices) {
        const Double3 &a = mesh.positions[vertex.a], &b = mesh.positions[vertex.b];
        after.positions.push_back({std::lerp(a.x, b.x, vertex.share),
                                   std::lerp(a.y, b.y, vertex.share),
                                   std::lerp(a.z, b.z, vertex.share)});
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!std::ranges::binary_search(cut.removed, i))
            after.triangles.push_back(mesh.triangles[i]);
    }
    after.triangles.insert(after.triangles.end(), cut.appended.begin(), cut.appended.end());
    return after;
}

/// Twice the area vector of a triangle: its length tells the area, its direction the winding.
Double3 area_vector(const TestMesh& mesh, const format::Triangle& triangle) {
    const Double3 &a = mesh.positions[triangle.vertex[0]], &b = mesh.positions[triangle.vertex[1]],
                  &c = mesh.positions[triangle.vertex[2]];
    const Double3 u = {b.x - a.x, b.y - a.y, b.z - a.z}, v = {c.x - a.x, c.y - a.y, c.z - a.z};
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

std::array<double, 4> areas_of(const TestMesh& mesh) {
    std::array<double, 4> sums{};
    for (const format::Triangle& triangle : mesh.triangles) {
        const Double3 area = area_vector(mesh, triangle);
        sums[0] += area.x;
        sums[1] += area.y;
        sums[2] += area.z;
        sums[3] += std::hypot(area.x, area.y, area.z);
    }
    return sums;
}

int exact_side(const Tear& tear, const Double3& point) {
    ExactNumber sum;
    const std::array<double, 3> at = {point.x, point.y, point.z};
    for (std::size_t i = 0; i < 3; ++i) {
        sum = sum + ExactNumber(tear.normal[i]) * (ExactNumber(at[i]) - ExactNumber(tear.point[i]));
    }
    return sum.sign();
}

// The oracle computes with numbers of any length.
TEST(SideOf, IsExact) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> fine(-1, 1);
    std::uniform_int_distribution<int> grid(-2, 2), size(-150, 150);
    std::array<int, 3> signs{};
    for (int round = 0; round < 20'000; ++round) {
        const auto draw = [&] { return round % 2 == 0 ? fine(random) : grid(random) * 0.1; };
        Tear tear = {.point = {draw(), draw(), draw()}, .normal = {draw(), draw(), draw()}};
        if (tear.normal == std::array<double, 3>{}) continue;
        std::array<double, 3> at = {draw(), draw(), draw()};
        if (round % 4 == 0) {  // a point that is in the plane, but for rounding
            at[2] = tear.point[2] - (tear.normal[0] * (at[0] - tear.point[0]) +
                                     tear.normal[1] * (at[1] - tear.point[1])) /
                                        tear.normal[2];
        }
        const double scale = std::scalbn(1.0, size(random)),
                     length = std::scalbn(1.0, size(random));
        for (std::size_t i = 0; i < 3; ++i) {
            tear.point[i] *= scale;
            at[i] *= scale;
            tear.normal[i] *= length;
        }
        const Double3 point = {at[0], at[1], at[2]};
        const int expected = exact_side(tear, point);
        ASSERT_EQ(side_of(tear, point), expected) << round;
        ++signs[static_cast<std::size_t>(expected + 1)];
    }
    for (const int count : signs) EXPECT_GT(count, 500);
}

TEST(SideOf, WorksAtTheEndsOfTheRange) {
    for (const double size : {0x1p1000, 0x1p-1070}) {
        const Tear tear = {.point = {size, -size, 0}, .normal = {size, size, 0}};
        EXPECT_EQ(side_of(tear, {-size, size, size}), 0);
        EXPECT_EQ(side_of(tear, {size, size, 0}), 1);
        EXPECT_EQ(side_of(tear, {-size, -size, 0}), -1);
    }
}

/// The laws that every cut obeys, checked for one.
class Laws {
public:
    Laws(const TestMesh& mesh, const Tear& tear)
        : mesh_(mesh), tear_(tear), cut_(cut_mesh(mesh, tear)), after_(after_cut(mesh, cut_)) {}

    void check() const {
        ASSERT_FALSE(cut_.misses);
        ASSERT_EQ(cut_.is_far.size(), after_.positions.size());
        keeps_areas();
        parts_sides();
        replaces_only_what_must();
    }
    [[nodiscard]] const Cut& cut() const {
        return cut_;
    }
    [[nodiscard]] const TestMesh& after() const {
        return after_;
    }

private:
    void keeps_areas() const {
        const auto before = areas_of(mesh_), now = areas_of(after_);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(now[i], before[i], 1e-12 * before[3]) << i;
    }

    /// No triangle has vertices of both sides, and all vertices are where they should.
    void parts_sides() const {
        for (const format::Triangle& triangle : after_.triangles) {
            for (const std::uint32_t vertex : triangle.vertex) {
                EXPECT_EQ(cut_.is_far[vertex], cut_.is_far[triangle.vertex[0]]);
                const int side = exact_side(tear_, after_.positions[vertex]);
                const int wrong = cut_.is_far[vertex] != 0 ? -1 : 1;
                if (vertex < mesh_.positions.size()) {
                    EXPECT_NE(side, wrong);
                } else {
                    EXPECT_NEAR(distance(after_.positions[vertex]), 0, 1e-13);
                }
            }
        }
    }

    /// What is removed has vertices on both sides, or a copied vertex.
    void replaces_only_what_must() const {
        EXPECT_TRUE(std::ranges::is_sorted(cut_.removed));
        std::set<std::uint32_t> copied;
        for (const CutVertex& vertex : cut_.vertices) {
            if (vertex.a == vertex.b) copied.insert(vertex.a);
        }
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            std::set<int> sides;
            bool has_copy = false;
            for (const std::uint32_t vertex : mesh_.triangles[i].vertex) {
                sides.insert(exact_side(tear_, mesh_.positions[vertex]));
                has_copy = has_copy || copied.contains(vertex);
            }
            const bool crosses = sides.contains(-1) && sides.contains(1);
            const bool moves = sides.contains(1) && has_copy;
            EXPECT_EQ(std::ranges::binary_search(cut_.removed, i), crosses || moves) << i;
        }
    }

    [[nodiscard]] double distance(const Double3& p) const {
        const auto& [x, y, z] = tear_.normal;
        const auto& q = tear_.point;
        return (x * (p.x - q[0]) + y * (p.y - q[1]) + z * (p.z - q[2])) / std::hypot(x, y, z);
    }

    const TestMesh& mesh_;
    Tear tear_;
    Cut cut_;
    TestMesh after_;
};

// A closed surface stays without gaps: only edges at the cut have no neighbour.
TEST(CutByPlane, CutsAClosedSurface) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> fine(-0.5, 0.5);
    for (int round = 0; round < 20; ++round) {
        const TestMesh ball = test::turned(test::icosphere(2), 0.1 * round);
        const Laws laws(ball, {.point = {fine(random), fine(random), fine(random)},
                               .normal = {fine(random), fine(random), fine(random)}});
        laws.check();
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        for (const format::Triangle& triangle : laws.after().triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t a = triangle.vertex[i], b = triangle.vertex[(i + 1) % 3];
                edges[std::minmax(a, b)] += a < b ? 1 : -1;
            }
        }
        int open = 0;
        for (const auto& [edge, uses] : edges) {
            if (uses == 0) continue;
            ++open;
            EXPECT_GE(edge.first, ball.positions.size());
        }
        EXPECT_GT(open, 20);
    }
}

// Vertices in the plane and triangles that touch it are common on a grid.
TEST(CutByPlane, CutsTrianglesOnAGrid) {
    std::size_t copies = 0, crossing = 0, in_plane = 0;
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
        const TestMesh soup = test::with_shared_vertices(test::coarse_grid_soup(seed, 200, 2));
        for (const std::array<double, 3>& normal : std::vector<std::array<double, 3>>{
                 {1, 0, 0}, {0, 0, -3}, {1, 1, 0}, {1, -1, 2}, {0.1, 0.2, 0.3}}) {
            const Tear tear = {.point = {0, 1, 0}, .normal = normal};
            const Laws laws(soup, tear);
            laws.check();
            for (const CutVertex& vertex : laws.cut().vertices) {
                ++(vertex.a == vertex.b ? copies : crossing);
            }
            for (const format::Triangle& triangle : soup.triangles) {
                in_plane += std::ranges::all_of(triangle.vertex, [&](std::uint32_t vertex) {
                    return exact_side(tear, soup.positions[vertex]) == 0;
                });
            }
        }
    }
    EXPECT_GT(copies, 500u);
    EXPECT_GT(crossing, 500u);
    EXPECT_GT(in_plane, 50u);
}

// By hand: two squares of two triangles each. The plane passes between them, through a column.
TEST(CutByPlane, CopiesVerticesInThePlane) {
    const TestMesh sheet = test::grid_sheet(2, 1);
    const Laws laws(sheet, {.point = {1, 0, 0}, .normal = {2, 0, 0}});
    laws.check();
    const Cut& cut = laws.cut();
    EXPECT_EQ(cut.vertices.size(), 2u) << "each vertex of the column has one copy";
    for (const CutVertex& vertex : cut.vertices) EXPECT_EQ(sheet.positions[vertex.a].x, 1);
    EXPECT_EQ(cut.removed.size(), 2u);
    EXPECT_EQ(cut.appended.size(), 2u) << "both triangles of the far square touch the column";
}

// By hand: two fragments of a triangle through a corner, three through its sides.
TEST(CutByPlane, SplitsATriangle) {
    const TestMesh triangle = test::right_triangle();
    const Laws corner(triangle, {.point = {0, 0, 0}, .normal = {1, -1, 0}});
    corner.check();
    EXPECT_EQ(corner.cut().appended.size(), 2u);
    EXPECT_EQ(corner.cut().vertices.size(), 3u) << "two at the side, one copy";
    const Laws sides(triangle, {.point = {1, 0, 0}, .normal = {1, 0, 0}});
    sides.check();
    EXPECT_EQ(sides.cut().appended.size(), 3u);
    EXPECT_EQ(sides.cut().vertices.size(), 4u);
}

// All vertices on one side: beside the plane, at it, or in it.
TEST(CutByPlane, ChangesNothingWhereItMisses) {
    const TestMesh cube = test::unit_cube(), sheet = test::grid_sheet(2, 2);
    for (const double height : {-5.0, 0.0, 1.0, 5.0}) {
        for (const double direction : {1.0, -1.0}) {
            const Cut cut = cut_mesh(cube, {.point = {0, 0, height}, .normal = {0, 0, direction}});
            EXPECT_TRUE(cut.misses) << height << " " << direction;
            EXPECT_TRUE(cut.removed.empty() && cut.appended.empty() && cut.vertices.empty());
        }
    }
    EXPECT_TRUE(cut_mesh(sheet, {}).misses);
    EXPECT_TRUE(cut_mesh({}, {}).misses);
}

// Each body lies on one side of the plane: no triangle is cut, and each keeps its vertices.
TEST(CutByPlane, PartsBodiesThatItDoesNotCross) {
    const TestMesh two =
        test::joined(test::unit_cube(), test::moved_by(test::unit_cube(), 1, {3, 0, 0}));
    const Laws laws(two, {.point = {2, 0, 0}, .normal = {1, 0, 0}});
    laws.check();
    EXPECT_TRUE(laws.cut().removed.empty() && laws.cut().appended.empty());
    EXPECT_EQ(std::ranges::count(laws.cut().is_far, 1), 8);
}

// By hand.
TEST(HalfOpening, PointsAlongTheNormal) {
    const Double3 half = half_opening({.normal = {0, 3, 4}, .opening = 10});
    EXPECT_NEAR(half.x, 0, 1e-15);
    EXPECT_NEAR(half.y, 3, 1e-15);
    EXPECT_NEAR(half.z, 4, 1e-15);
    EXPECT_NEAR(half_opening({.normal = {0x1p1000, 0, 0}, .opening = 1}).x, 0.5, 1e-15);
}

}  // namespace
}  // namespace cdprep::scenes
