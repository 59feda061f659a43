// SPDX-License-Identifier: MIT
#include "decompose/enclose/solid_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mesh/vectors.h"
#include "support/run_threads.h"
#include "unit/tools/soup_of.h"

#include "exact/predicates.h"

namespace cdprep::convex {
namespace {

using mesh::Mesh;
using test::mesh_of;

/// Of dyadic coordinates, and cut there: nothing is rounded.
Mesh cube(double side) {
    return mesh_of(test::moved_by(test::unit_cube(), side, {0, 0, 0}));
}

/// Nothing about it is a round number.
Mesh crooked() {
    test::TestMesh ball = test::icosphere(1);
    for (Double3& p : ball.positions) {
        p = {1.1 * p.x + 0.3 * p.y + 0.017, 0.7 * p.y - 0.2 * p.z + 0.3, 0.9 * p.z + 0.1 * p.x};
    }
    return mesh_of(ball);
}

SolidCells cells_of(const Mesh& mesh, const SolidCellOptions& options) {
    const Solid solid(mesh, Reference::solid, options.parallel_for);
    const DistanceField field(solid, options.size / 8, options.size, options.parallel_for);
    return cut_into_cells(mesh, solid, field, options);
}

/// Far more is allowed to stick out than can: cells are cut for their size alone.
SolidCells cells_by_size(const Mesh& mesh, double size) {
    SolidCellOptions options;
    options.size = size;
    options.error = 100;
    return cells_of(mesh, options);
}

double volume(const mesh::Box& box) {
    const Double3 size = mesh::minus(box.upper, box.lower);
    return size.x * size.y * size.z;
}

bool is_point(const Place& place) {
    return place.lower == place.upper;
}

double area(const Double3& a, const Double3& b, const Double3& c) {
    const Double3 n = mesh::cross(mesh::minus(b, a), mesh::minus(c, a));
    return std::sqrt(mesh::dot(n, n)) / 2;
}

// Boxes without a common point of their inside, whose volumes add up to the cube's: they are
// all of it. The sides of a right-angled triangle, halved: every number is exact.
TEST(SolidCells, FillACubeExactly) {
    for (const double size : {2.0, 1.0, 0.5}) {
        const SolidCells cells = cells_by_size(cube(2), size);
        double sum = 0;
        for (std::size_t i = 0; i < cells.cells.size(); ++i) {
            const mesh::Box& a = cells.cells[i].box;
            sum += volume(a);
            for (std::size_t k = 0; k < i; ++k) {
                const mesh::Box& b = cells.cells[k].box;
                const bool apart = a.upper.x <= b.lower.x || b.upper.x <= a.lower.x ||
                                   a.upper.y <= b.lower.y || b.upper.y <= a.lower.y ||
                                   a.upper.z <= b.lower.z || b.upper.z <= a.lower.z;
                EXPECT_TRUE(apart);
            }
            EXPECT_EQ(cells.cells[i].corners.size(), 8u);
        }
        EXPECT_EQ(sum, 8.0);
        EXPECT_TRUE(std::all_of(cells.places.begin(), cells.places.end(), is_point));
    }
}

/// How many cells hold each fragment.
std::vector<std::uint32_t> uses_of_fragments(const SolidCells& cells) {
    std::vector<std::uint32_t> uses(cells.fragments.size(), 0);
    for (const SolidCell& cell : cells.cells) {
        for (const std::uint32_t fragment : cell.fragments) ++uses[fragment];
    }
    return uses;
}

// Fragments that cells hold add up to their triangle at least, for some are copies: by areas,
// which only sums of as many terms round. The cuts of the last cube meet its diagonals in places
// that touch other cuts, but are not on them.
TEST(SolidCells, FragmentsCoverTheirTriangles) {
    for (const Mesh& mesh : {cube(2), crooked(), cube(1.4225655996704496)}) {
        const SolidCells cells = cells_by_size(mesh, 0.3);
        std::vector<double> sum(mesh.triangles.size(), 0);
        std::vector<std::uint32_t> count(mesh.triangles.size(), 0);
        const std::vector<std::uint32_t> uses = uses_of_fragments(cells);
        for (std::size_t i = 0; i < uses.size(); ++i) {
            const Fragment& f = cells.fragments[i];
            EXPECT_EQ(uses[i], 1U);  // none is left over where others were trimmed
            sum[f.triangle] += area(cells.places[f.place[0]].lower, cells.places[f.place[1]].lower,
                                    cells.places[f.place[2]].lower);
            ++count[f.triangle];
        }
        EXPECT_EQ(count, cells.fragment_count);
        EXPECT_GT(cells.fragments.size(), mesh.triangles.size());
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const auto& v = mesh.triangles[i].vertex;
            EXPECT_GE(sum[i] + 1e-12,
                      area(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]));
        }
    }
}

// A cut's exact place is on its triangle's plane and in its box. The box around it, a few
// roundings wide, has corners on both sides then, or on the plane; exactly.
TEST(SolidCells, PlacesHoldTheExactPoints) {
    const Mesh mesh = crooked();
    const SolidCells cells = cells_by_size(mesh, 0.3);
    std::size_t rounded = 0;
    for (const Fragment& f : cells.fragments) {
        const auto& v = mesh.triangles[f.triangle].vertex;
        mesh::Box box;
        for (const std::uint32_t vertex : v) box.add(mesh.positions[vertex]);
        for (const std::uint32_t number : f.place) {
            const Place& place = cells.places[number];
            EXPECT_TRUE(box.contains(place.lower) && box.contains(place.upper));
            std::array<bool, 3> sides{};
            for (unsigned k = 0; k < 8; ++k) {
                const Double3 corner = {(k & 1U) == 0 ? place.lower.x : place.upper.x,
                                        (k & 2U) == 0 ? place.lower.y : place.upper.y,
                                        (k & 4U) == 0 ? place.lower.z : place.upper.z};
                const int sign = orient3d(mesh.positions[v[0]], mesh.positions[v[1]],
                                          mesh.positions[v[2]], corner);
                sides[static_cast<std::size_t>(sign + 1)] = true;
            }
            EXPECT_TRUE(sides[1] || (sides[0] && sides[2]));
            const Double3 width = mesh::minus(place.upper, place.lower);
            EXPECT_LE(std::max({width.x, width.y, width.z}), 1e-13);
            rounded += is_point(place) ? 0 : 1;
        }
    }
    EXPECT_GT(rounded, 100u);
}

// Each lies in the cells that it is handed to, up to what is not cut: triangles much smaller
// than a cell. Here none is.
TEST(SolidCells, HoldEveryFragmentInTheirBoxes) {
    const Mesh mesh = crooked();
    const SolidCells cells = cells_by_size(mesh, 0.6);
    for (const SolidCell& cell : cells.cells) {
        for (const std::uint32_t fragment : cell.fragments) {
            mesh::Box box;
            for (const std::uint32_t place : cells.fragments[fragment].place) {
                box.add(cells.places[place].lower);
                box.add(cells.places[place].upper);
            }
            EXPECT_TRUE(box.meets(cell.box));
        }
    }
    EXPECT_LT(std::ranges::max(uses_of_fragments(cells)), 2u);
}

// A small cube in a cavity of the shape of a cube, in a large one: a corner is listed where
// it is in the body, closed; by comparisons of coordinates.
TEST(SolidCells, ListTheCornersWithinTheirBody) {
    const test::TestMesh outer = test::moved_by(test::unit_cube(), 8, {0, 0, 0});
    const test::TestMesh cavity = test::reversed(test::moved_by(test::unit_cube(), 4, {2, 2, 2}));
    const test::TestMesh inner = test::moved_by(test::unit_cube(), 1, {3, 3, 3});
    const Mesh mesh = mesh_of(test::joined(test::joined(outer, cavity), inner));
    const Solid solid(mesh, Reference::solid, serial_for);
    ASSERT_EQ(solid.body_count(), 2u);
    const std::uint32_t inner_body = solid.body_of(24);
    const auto in_cube = [](const Double3& p, double lower, double upper) {
        return std::min({p.x, p.y, p.z}) >= lower && std::max({p.x, p.y, p.z}) <= upper;
    };
    const auto strictly = [](const Double3& p, double lower, double upper) {
        return std::min({p.x, p.y, p.z}) > lower && std::max({p.x, p.y, p.z}) < upper;
    };
    const SolidCells cells = cells_by_size(mesh, 1);
    std::array<std::size_t, 2> listed{};
    for (const SolidCell& cell : cells.cells) {
        for (unsigned k = 0; k < 8; ++k) {
            const Double3 p = {(k & 1U) == 0 ? cell.box.lower.x : cell.box.upper.x,
                               (k & 2U) == 0 ? cell.box.lower.y : cell.box.upper.y,
                               (k & 4U) == 0 ? cell.box.lower.z : cell.box.upper.z};
            const bool is_inner = cell.body == inner_body;
            const bool expected =
                is_inner ? in_cube(p, 3, 4) : in_cube(p, 0, 8) && !strictly(p, 2, 6);
            const bool found =
                std::find(cell.corners.begin(), cell.corners.end(), p) != cell.corners.end();
            EXPECT_EQ(found, expected) << p.x << ' ' << p.y << ' ' << p.z;
            listed[is_inner ? 1 : 0] += found ? 1 : 0;
        }
    }
    EXPECT_GT(std::min(listed[0], listed[1]), 0u);
}

TEST(SolidCells, AreNoMoreThanAllowed) {
    SolidCellOptions options;
    options.size = 0.01;
    options.error = 1e-4;
    options.most_cells = 50;
    const SolidCells cells = cells_of(crooked(), options);
    EXPECT_LE(cells.cells.size(), 50u);
    EXPECT_GT(cells.cells.size(), 12u);
}

// Smaller where a hull would stick out of a dent: a cell as large as the ring closes its hole.
TEST(SolidCells, AreCutWhereTheirHullsWouldStickOut) {
    const Mesh ring = mesh_of(test::torus(1, 0.25, 32, 16));
    SolidCellOptions loose;
    loose.size = 3;
    loose.error = 2;
    SolidCellOptions tight = loose;
    tight.error = 0.05;
    EXPECT_EQ(cells_of(ring, loose).cells.size(), 1u);
    EXPECT_GT(cells_of(ring, tight).cells.size(), 8u);
}

TEST(SolidCells, AreTheSameForAnyThreads) {
    const Mesh mesh = crooked();
    SolidCellOptions serial;
    serial.size = 0.4;
    serial.error = 0.05;
    SolidCellOptions threads = serial;
    // Not all at once: there are more tasks than a system has threads.
    const auto run = [](std::size_t count, Task task) {
        for (std::size_t first = 0; first < count; first += 8) {
            const auto some = [&](std::size_t i) { task(first + i); };
            test::run_threads(std::min<std::size_t>(8, count - first), some);
        }
    };
    threads.parallel_for = run;
    const SolidCells a = cells_of(mesh, serial);
    const SolidCells b = cells_of(mesh, threads);
    ASSERT_EQ(a.cells.size(), b.cells.size());
    for (std::size_t i = 0; i < a.cells.size(); ++i) {
        EXPECT_EQ(a.cells[i].fragments, b.cells[i].fragments);
        EXPECT_EQ(a.cells[i].corners, b.cells[i].corners);
        EXPECT_EQ(a.cells[i].box.lower, b.cells[i].box.lower);
        EXPECT_EQ(a.cells[i].box.upper, b.cells[i].box.upper);
    }
    ASSERT_EQ(a.fragments.size(), b.fragments.size());
    for (std::size_t i = 0; i < a.fragments.size(); ++i) {
        EXPECT_EQ(a.fragments[i].place, b.fragments[i].place);
        EXPECT_EQ(a.fragments[i].triangle, b.fragments[i].triangle);
    }
}

}  // namespace
}  // namespace cdprep::convex
