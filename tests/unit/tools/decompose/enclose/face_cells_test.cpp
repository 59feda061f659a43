// SPDX-License-Identifier: MIT
#include "decompose/enclose/face_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "decompose/enclose/join_cells.h"
#include "decompose/enclose/part_points.h"
#include "support/concave_solids.h"
#include "unit/tools/hull_flaw.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using mesh::Mesh;
using test::mesh_of;

/// Three unit cubes, turned.
Mesh l_prism(double angle) {
    return mesh_of(test::turned(test::l_prism(), angle));
}

/// Steps from the upper left to the lower right: their planes cut it into unit cubes.
Mesh stairs(int steps) {
    std::vector<std::array<double, 2>> outline = {{0, 0}, {static_cast<double>(steps), 0}};
    for (int i = 1; i <= steps; ++i) {
        const double x = steps - i, y = i;
        outline.insert(outline.end(), {{x + 1, y}, {x, y}});
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 1; i + 1 < outline.size(); ++i) triangles.push_back({0, i, i + 1});
    return mesh_of(test::prism(outline, triangles));
}

/// Notches between teeth: two planes for each notch, and one through all their floors.
Mesh comb(int notches) {
    std::vector<std::array<double, 2>> outline = {{0, 0}, {2.0 * notches + 1, 0}};
    std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}};
    for (int left = notches; left >= 0; --left) {
        const double x = 2 * left + 1;
        const auto i = static_cast<std::uint32_t>(outline.size());
        outline.insert(outline.end(), {{x, 1}, {x, 2}, {x - 1, 2}, {x - 1, 1}});
        triangles.insert(triangles.end(), {{i, i + 1, i + 2}, {i, i + 2, i + 3}, {0, i, i + 3}});
        if (left > 0) triangles.push_back({0, i + 3, i + 4});
    }
    return mesh_of(test::prism(outline, triangles));
}

std::optional<SolidCells> cells_of(const Mesh& mesh) {
    const Solid solid(mesh, Reference::solid, serial_for);
    return cut_along_faces(mesh, solid, std::vector<bool>(solid.body_count(), true));
}

ConvexHull hull_of(const SolidCells& cells, const SolidCell& cell) {
    std::vector<Double3> points = cell.corners;
    for (const std::uint32_t fragment : cell.fragments) {
        for (const std::uint32_t place : cells.fragments[fragment].place) {
            points.push_back(cells.places[place].lower);
            points.push_back(cells.places[place].upper);
        }
    }
    return convex_hull(points);
}

/// Of the tetrahedra between its facets and the origin.
double volume_of(const ConvexHull& hull) {
    double sum = 0;
    for (const auto& f : hull.facets) {
        const Double3 &a = hull.points[f[0]], &b = hull.points[f[1]], &c = hull.points[f[2]];
        sum += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
               a.z * (b.x * c.y - b.y * c.x);
    }
    return sum / 6;
}

// The planes of the notch's two walls cut it into three unit cubes.
TEST(FaceCells, OfAnLPrismAreThreeCubesHoweverItIsTurned) {
    for (const double angle : {0.0, 0.3, 0.8, 2.0}) {
        const auto cells = cells_of(l_prism(angle));
        ASSERT_TRUE(cells);
        ASSERT_EQ(cells->cells.size(), 3u) << angle;
        std::vector<std::uint32_t> count(20, 0);
        for (const SolidCell& cell : cells->cells) {
            EXPECT_NEAR(volume_of(hull_of(*cells, cell)), 1, 1e-9);
            for (const std::uint32_t i : cell.fragments) ++count[cells->fragments[i].triangle];
        }
        EXPECT_EQ(count, cells->fragment_count);
    }
}

// A Z of four cubes: one plane has a face of the solid above it, and another below.
TEST(FaceCells, OfAZPrismAreFourCubes) {
    const auto cells = cells_of(
        mesh_of(test::prism({{1, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 2}, {0, 2}, {0, 1}, {1, 1}},
                            {{0, 1, 2}, {0, 2, 3}, {0, 3, 7}, {3, 4, 5}, {3, 5, 7}, {5, 6, 7}})));
    ASSERT_TRUE(cells);
    ASSERT_EQ(cells->cells.size(), 4u);
    for (const SolidCell& cell : cells->cells) {
        EXPECT_NEAR(volume_of(hull_of(*cells, cell)), 1, 1e-9);
    }
}

// Points of a grid that hits faces, edges and cuts, of the solid as it is stored.
TEST(FaceCells, LeaveNoCracks) {
    const auto cells = cells_of(l_prism(0));
    ASSERT_TRUE(cells);
    std::vector<ConvexHull> hulls;
    for (const SolidCell& cell : cells->cells) hulls.push_back(hull_of(*cells, cell));
    for (int x = 0; x <= 8; ++x) {
        for (int y = 0; y <= 8; ++y) {
            for (int z = 0; z <= 4; ++z) {
                const Double3 p = {x / 4.0, y / 4.0, z / 4.0};
                const bool is_held = std::any_of(hulls.begin(), hulls.end(), [&](const auto& hull) {
                    return test::holds(hull, p);
                });
                EXPECT_EQ(is_held, x <= 4 || y <= 4) << x << y << z;
            }
        }
    }
}

TEST(FaceCells, OfWhatIsNotWantedAreNone) {
    const Mesh mesh = l_prism(0);
    const Solid solid(mesh, Reference::solid, serial_for);
    const auto cells = cut_along_faces(mesh, solid, {false});
    ASSERT_TRUE(cells);
    EXPECT_TRUE(cells->cells.empty());
}

TEST(FaceCells, AreNothingBeyondALimit) {
    const auto of_comb = cells_of(comb(15));
    ASSERT_TRUE(of_comb);
    EXPECT_EQ(of_comb->cells.size(), 47u);
    EXPECT_FALSE(cells_of(comb(16)));  // 33 planes
    const auto of_stairs = cells_of(stairs(15));
    ASSERT_TRUE(of_stairs);
    EXPECT_EQ(of_stairs->cells.size(), 120u);
    EXPECT_FALSE(cells_of(stairs(16)));  // 136 cells
    const Mesh fine = mesh_of(test::box_with_a_fine_side(30, 30));
    const Mesh finer = mesh_of(test::box_with_a_fine_side(32, 32));
    EXPECT_LE(fine.triangles.size(), 4000u);
    EXPECT_GT(finer.triangles.size(), 4000u);
    EXPECT_TRUE(cells_of(fine));
    EXPECT_FALSE(cells_of(finer));
}

TEST(FaceCells, AreNothingWithManyFacesOrWithoutASolid) {
    Mesh open = l_prism(0);
    open.triangles.pop_back();
    EXPECT_FALSE(cells_of(open));
    Mesh dented = mesh_of(test::icosphere(3));
    for (std::size_t i = 0; i < dented.positions.size(); i += 2) {
        Double3& p = dented.positions[i];
        p = {0.9 * p.x, 0.9 * p.y, 0.9 * p.z};
    }
    EXPECT_FALSE(cells_of(dented));
}

// Two of the cubes in a row are a bar; the third stays: with an error of half a side, the
// notch's, all three are one.
TEST(JoinCells, CoverAnLPrismWithTwoBarsOrWithOneHull) {
    for (const double angle : {0.0, 0.8}) {
        const Mesh mesh = l_prism(angle);
        const Solid solid(mesh, Reference::solid, serial_for);
        const auto cells = cut_along_faces(mesh, solid, {true});
        ASSERT_TRUE(cells);
        const std::vector<std::uint32_t> all = {0, 1, 2};
        const auto two = join_cells(*cells, all, solid, 0, serial_for);
        ASSERT_EQ(two.size(), 2u);
        for (const auto& bar : two) EXPECT_EQ(bar.size(), 2u);
        EXPECT_EQ(join_cells(*cells, all, solid, 0.4, serial_for).size(), 2u);
        EXPECT_EQ(join_cells(*cells, all, solid, 0.6, serial_for).size(), 1u);
        const std::vector<std::uint32_t> one = {1};
        EXPECT_EQ(join_cells(*cells, one, solid, 0, serial_for),
                  std::vector<std::vector<std::uint32_t>>{one});
    }
}

/// Blocks of a grid with columns and rows of different widths, from z = 0 to 1. Two runs of blocks,
/// each with bumps on one side, meet at a corner; other runs continue them.
Mesh blocks_in_a_grid() {
    std::set<std::array<int, 2>> blocks = {{0, 0}, {2, 0}, {4, 0}, {4, 2}, {5, 2},
                                           {5, 4}, {7, 4}, {9, 4}, {14, 1}};
    for (int x = 0; x < 5; ++x) blocks.insert({x, 1});
    for (int x = 5; x < 12; ++x) blocks.insert({x, 3});
    for (int x = 11; x < 17; ++x) blocks.insert({x, 2});
    const std::array<double, 18> x_of = {0, 1,  2,  3,  4,  5,  6,  7,   8,
                                         9, 10, 11, 12, 42, 72, 73, 103, 133};
    const std::array<double, 6> y_of = {0, 1, 2, 4, 5, 6};
    Mesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> known;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [found, is_new] =
            known.try_emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) {
            mesh.positions.push_back({x_of[static_cast<std::size_t>(at[0])],
                                      y_of[static_cast<std::size_t>(at[1])],
                                      static_cast<double>(at[2])});
        }
        return found->second;
    };
    const auto add_side = [&](const std::array<std::array<int, 3>, 4>& corners) {
        const std::array<std::uint32_t, 4> v = {vertex(corners[0]), vertex(corners[1]),
                                                vertex(corners[2]), vertex(corners[3])};
        mesh.triangles.push_back({{v[0], v[1], v[2]}});
        mesh.triangles.push_back({{v[0], v[2], v[3]}});
    };
    for (const auto& [x, y] : blocks) {
        const int u = x + 1, v = y + 1;
        add_side({{{x, y, 1}, {u, y, 1}, {u, v, 1}, {x, v, 1}}});
        add_side({{{x, y, 0}, {x, v, 0}, {u, v, 0}, {u, y, 0}}});
        if (!blocks.contains({x - 1, y})) {
            add_side({{{x, y, 0}, {x, y, 1}, {x, v, 1}, {x, v, 0}}});
        }
        if (!blocks.contains({u, y})) add_side({{{u, y, 0}, {u, v, 0}, {u, v, 1}, {u, y, 1}}});
        if (!blocks.contains({x, y - 1})) {
            add_side({{{x, y, 0}, {u, y, 0}, {u, y, 1}, {x, y, 1}}});
        }
        if (!blocks.contains({x, v})) add_side({{{x, v, 0}, {x, v, 1}, {u, v, 1}, {u, v, 0}}});
    }
    return mesh;
}

// Later unions take in all cells of an earlier one. A part of such cells would have no points.
TEST(JoinCells, EveryUnionHasACellOfItsOwn) {
    const Mesh mesh = blocks_in_a_grid();
    const Solid solid(mesh, Reference::solid, serial_for);
    const auto cells = cut_along_faces(mesh, solid, {true});
    ASSERT_TRUE(cells);
    std::vector<std::uint32_t> all(cells->cells.size());
    std::iota(all.begin(), all.end(), 0U);
    const auto unions = join_cells(*cells, all, solid, 0, serial_for);
    std::vector<int> uses(all.size(), 0);
    for (const auto& cells_of_union : unions) {
        for (const std::uint32_t cell : cells_of_union) ++uses[cell];
    }
    EXPECT_TRUE(std::all_of(uses.begin(), uses.end(), [](int count) { return count > 0; }));
    for (const auto& cells_of_union : unions) {
        EXPECT_TRUE(std::any_of(cells_of_union.begin(), cells_of_union.end(),
                                [&](std::uint32_t cell) { return uses[cell] == 1; }));
    }
    for (const PartPoints& part : gather_points(*cells, mesh, unions)) {
        EXPECT_FALSE(part.points.empty());
    }
}

}  // namespace
}  // namespace cdprep::convex
