// SPDX-License-Identifier: MIT
#include "cdprep/advanced/build_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "cdprep/pairs.h"
#include "cdprep/pose.h"
#include "support/brute_force.h"
#include "support/bvh_boxes.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

using build::build_bvh;
using build::Bvh;
using build::Quality;
using format::BvhShape;

constexpr Quality kQualities[] = {Quality::best, Quality::fast};

/// Triangles that are one point each, the same for all.
TestMesh one_point(int count) {
    TestMesh mesh = copies_of_one_triangle(count);
    for (Double3& p : mesh.positions) p = {3, -2, 0.5};
    return mesh;
}

/// Middles all along one line, most of them in one place.
TestMesh crowded(int count) {
    TestMesh mesh = random_soup(7, count, 0.001);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        Double3& p = mesh.positions[i];
        const bool outlier = i / 3 % 50 == 0;
        p = {outlier ? p.x : 1e-30 * p.x, 0, outlier ? 1 : 1e-30};
    }
    return mesh;
}

std::vector<TestMesh> awkward_meshes() {
    return {TestMesh{},
            fan(1),
            fan(8),
            fan(9),
            fan(64),
            fan(65),
            one_point(1),
            one_point(700),
            crowded(600),
            moved_by(fan(70), 0x1p-1060, {}),  // subnormal
            moved_by(unit_cube(), 0x1p999, {-0x1p999, 0, 0}),
            unit_cube(),
            grid_sheet(20, 30),
            icosphere(3),
            random_soup(1, 700, 0.3),
            coarse_grid_soup(2, 500, 3),
            copies_of_one_triangle(1000),
            geometric_progression(900),
            moved_by(icosphere(2), 0x1p-1000, {}),
            moved_by(icosphere(2), 0x1p998, {}),
            moved_by(icosphere(2), 1e-3, {1e9, -1e9, 1e9})};
}

bool all_floats(const TestMesh& mesh) {
    const auto same = [](double x) { return double{static_cast<float>(x)} == x; };
    return std::all_of(mesh.positions.begin(), mesh.positions.end(),
                       [&](const Double3& p) { return same(p.x) && same(p.y) && same(p.z); });
}

TEST(BuildBvh, EveryBoxHoldsItsTrianglesInExactArithmetic) {
    for (const Quality quality : kQualities) {
        for (const TestMesh& mesh : awkward_meshes()) {
            EXPECT_TRUE(boxes_hold_all(
                mesh, build_bvh(mesh.positions, mesh.triangles, {.quality = quality})));
        }
    }
}

// Leaves hold the corners, oriented boxes the vertices: find_deep_damage() works
// that out anew from positions and triangles.
TEST(BuildBvh, LeavesAndOrientedBoxesHoldTheirTriangles) {
    int asked = 0;
    for (const TestMesh& mesh : awkward_meshes()) {
        for (const bool double_precision : {false, true}) {
            if (!double_precision && !all_floats(mesh)) continue;
            ++asked;
            for (const Quality quality : kQualities) {
                const AlignedBytes file =
                    bake_tiny(mesh.positions, mesh.triangles,
                              {.double_precision = double_precision, .quality = quality});
                const auto damage = format::find_deep_damage(file.span());
                EXPECT_FALSE(damage) << format::section_name(damage->section) << " " << damage->at;
            }
        }
    }
    EXPECT_GT(asked, 25);
}

constexpr std::array<build::BvhBounds, 3> kSwept = {build::BvhBounds::swept_points,
                                                    build::BvhBounds::swept_lines,
                                                    build::BvhBounds::swept_rectangles};

/// Whether a point of a swept sphere's middle is within the radius, in exact arithmetic.
/// The point is found in double: any point of the middle proves it.
bool swept_sphere_holds(const format::SweptNode& node, std::uint32_t box,
                        const std::array<ExactNumber, 3>& vertex) {
    std::array<ExactNumber, 3> rest;
    for (std::size_t i = 0; i < 3; ++i) rest[i] = vertex[i] - ExactNumber(node.centre[i][box]);
    for (const format::SweptSide& side : node.side) {
        double along = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            along += static_cast<double>(rest[i].approximation()) * side.axis[i][box];
        }
        const double half = side.half[box];
        along = std::clamp(along, -half, half);
        for (std::size_t i = 0; i < 3; ++i) {
            rest[i] = rest[i] - ExactNumber(along) * ExactNumber(side.axis[i][box]);
        }
    }
    const ExactNumber squared = rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2];
    const ExactNumber radius(node.radius[box]);
    return squared <= radius * radius;
}

TEST(BuildBvh, EverySweptSphereHoldsItsTrianglesInExactArithmetic) {
    for (const TestMesh& mesh : awkward_meshes()) {
        for (const build::BvhBounds bounds : kSwept) {
            const Bvh bvh = build_bvh(mesh.positions, mesh.triangles, {.bounds = bounds});
            const auto count = static_cast<std::uint32_t>(bvh.order.size());
            const BvhShape shape = format::bvh_shape(count);
            ASSERT_EQ(bvh.swept_nodes.size(), shape.node_count);
            ASSERT_TRUE(bvh.oriented_nodes.empty());
            const double origin[3] = {bvh.frame.origin.x, bvh.frame.origin.y, bvh.frame.origin.z};
            for (std::uint32_t level = 0; level < shape.levels; ++level) {
                for (std::uint32_t i = 0; i < count; ++i) {
                    const std::uint32_t place = i >> (3 * (level + 1));  // of 8^(level + 1)
                    const format::SweptNode& node =
                        bvh.swept_nodes[shape.first[level] + place / format::kBvhWidth];
                    for (const std::uint32_t v : mesh.triangles[bvh.order[i]].vertex) {
                        const Double3& p = mesh.positions[v];
                        const std::array<ExactNumber, 3> at = {
                            in_frame(p.x, origin[0], bvh.frame.exponent),
                            in_frame(p.y, origin[1], bvh.frame.exponent),
                            in_frame(p.z, origin[2], bvh.frame.exponent)};
                        ASSERT_TRUE(swept_sphere_holds(node, place % format::kBvhWidth, at));
                    }
                }
            }
        }
    }
}

// find_deep_damage() works it out anew from positions and triangles.
TEST(BuildBvh, SweptSpheresPassTheDeepCheck) {
    int asked = 0;
    for (const TestMesh& mesh : awkward_meshes()) {
        for (const build::BvhBounds bounds : kSwept) {
            for (const bool double_precision : {false, true}) {
                if (!double_precision && !all_floats(mesh)) continue;
                ++asked;
                const AlignedBytes file =
                    bake_tiny(mesh.positions, mesh.triangles,
                              {.double_precision = double_precision, .bounds = bounds});
                const auto damage = format::find_deep_damage(file.span());
                EXPECT_FALSE(damage) << format::section_name(damage->section) << " " << damage->at;
            }
        }
    }
    EXPECT_GT(asked, 75);
}

// By hand: the sheet lies in one plane and is longer than wide.
TEST(BuildBvh, SweptSpheresOfATurnedSheetAreTight) {
    TestMesh sheet = grid_sheet(4, 16);  // 128 triangles: two levels
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {0, 0, 0}).value();
    for (Double3& p : sheet.positions) p = transform_point(pose, p);
    const auto root_with = [&](build::BvhBounds bounds) {
        return build_bvh(sheet.positions, sheet.triangles, {.bounds = bounds});
    };
    const Bvh points = root_with(build::BvhBounds::swept_points);
    const Bvh lines = root_with(build::BvhBounds::swept_lines);
    const Bvh rectangles = root_with(build::BvhBounds::swept_rectangles);
    EXPECT_EQ(rectangles.swept_kind, format::SweptKind::rectangle);
    EXPECT_EQ(lines.swept_kind, format::SweptKind::line);
    int used = 0;
    for (std::size_t node = 0; node < points.swept_nodes.size(); ++node) {
        for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
            const double ball = points.swept_nodes[node].radius[box];
            if (ball == 0) continue;  // unused
            ++used;
            const double capsule = lines.swept_nodes[node].radius[box];
            EXPECT_LT(rectangles.swept_nodes[node].radius[box], 1e-6);
            EXPECT_LT(capsule, ball * (1 + 1e-5));
            EXPECT_EQ(points.swept_nodes[node].side[0].half[box], 0);
            EXPECT_EQ(lines.swept_nodes[node].side[1].half[box], 0);
        }
    }
    EXPECT_EQ(used, 2 + 16);  // 128 triangles: 16 leaves of 8, two nodes of those
}

TEST(BuildBvh, LeavesAreExactWhereAllCoordinatesAreFloats) {
    const TestMesh cube = unit_cube();
    EXPECT_TRUE(build_bvh(cube.positions, cube.triangles).exact_leaves);
    TestMesh tenths = cube;
    tenths.positions[0].x = 0.1;
    EXPECT_FALSE(build_bvh(tenths.positions, tenths.triangles).exact_leaves);
    const TestMesh tiny = moved_by(cube, 0x1p-120, {});
    EXPECT_FALSE(build_bvh(tiny.positions, tiny.triangles).exact_leaves);
}

TEST(BuildBvh, OrientedBoxesOfATurnedSheetAreThin) {
    TestMesh sheet = grid_sheet(20, 30);
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {0, 0, 0}).value();
    for (Double3& p : sheet.positions) p = transform_point(pose, p);
    const Bvh bvh = build_bvh(sheet.positions, sheet.triangles);
    ASSERT_FALSE(bvh.oriented_nodes.empty());
    int used = 0;
    for (const format::OrientedNode& node : bvh.oriented_nodes) {
        for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
            if (node.half[0][box] < 0) continue;  // unused
            EXPECT_LT(node.half[0][box], 1e-4F * node.half[2][box]);
            ++used;
        }
    }
    EXPECT_EQ(used, 150 + 19 + 3);  // 1,200 triangles, eight to a leaf, eight boxes to a node
}

// A slanted cylinder, open at its ends: no axis of a box is along one of the model. The
// bound was stored from a build, which gives the same boxes on every machine: 27.168.
TEST(BuildBvh, OrientedBoxesOfASlantedCylinderAreTight) {
    constexpr int kRows = 24, kColumns = 48;
    TestMesh tube = grid_sheet(kColumns, kRows);
    const Pose pose = Pose::from_quaternion(4, 1, -2, 3, {0, 0, 0}).value();
    for (Double3& p : tube.positions) {
        const double angle = 2 * 3.14159265358979 * p.x / kColumns;
        const Double3 on_tube = {std::cos(angle), std::sin(angle),
                                 0.1 * p.y + 0.3 * std::cos(angle)};
        p = transform_point(pose, on_tube);
    }
    const Bvh bvh = build_bvh(tube.positions, tube.triangles);
    double area = 0;  // an eighth of it
    int boxes = 0;
    for (const format::OrientedNode& node : bvh.oriented_nodes) {
        for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
            const double x = node.half[0][box], y = node.half[1][box], z = node.half[2][box];
            if (x < 0) continue;  // unused
            area += x * y + y * z + z * x;
            ++boxes;
        }
    }
    EXPECT_GT(boxes, 300);
    const double unit = std::ldexp(1.0, -2 * bvh.frame.exponent);
    EXPECT_LT(area * unit, 27.2);
}

TEST(BuildBvh, TheOrderNamesEveryTriangleOnce) {
    for (const Quality quality : kQualities) {
        for (const TestMesh& mesh : awkward_meshes()) {
            std::vector<std::uint32_t> order =
                build_bvh(mesh.positions, mesh.triangles, {.quality = quality}).order;
            std::sort(order.begin(), order.end());
            std::vector<std::uint32_t> all(mesh.triangles.size());
            std::iota(all.begin(), all.end(), 0U);
            EXPECT_EQ(order, all);
        }
    }
}

TEST(BuildBvh, UsedBoxesLieInTheUnitFrameAndUnusedOnesAreEmpty) {
    for (const TestMesh& mesh : awkward_meshes()) {
        const Bvh bvh = build_bvh(mesh.positions, mesh.triangles);
        const BvhShape shape = format::bvh_shape(static_cast<std::uint32_t>(bvh.order.size()));
        ASSERT_EQ(bvh.nodes.size(), shape.node_count);
        for (std::uint32_t level = 0; level < shape.levels; ++level) {
            for (std::uint32_t n = 0; n < shape.count[level]; ++n) {
                const format::BvhNode& node = bvh.nodes[shape.first[level] + n];
                for (std::uint32_t box = 0; box < format::kBvhWidth; ++box) {
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        const float lower = node.lower[axis][box], upper = node.upper[axis][box];
                        if (box < shape.used_boxes(level, n)) {
                            EXPECT_TRUE(-1 <= lower && lower <= upper && upper <= 1);
                        } else {
                            EXPECT_TRUE(lower == 1 && upper == -1);
                        }
                    }
                }
            }
        }
    }
}

/// Every body on a thread of its own, last first.
constexpr auto threads_for = [](std::size_t count, Task task) {
    std::vector<std::thread> threads;
    for (std::size_t i = count; i-- > 0;) threads.emplace_back(task, i);
    for (std::thread& thread : threads) thread.join();
};

/// On this many threads, in an order drawn anew each time.
auto shuffled_on(std::size_t threads, std::uint32_t seed) {
    return [threads, random = std::mt19937(seed)](std::size_t count, Task task) mutable {
        std::vector<std::size_t> order(count);
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::shuffle(order.begin(), order.end(), random);
        std::atomic<std::size_t> next = 0;
        std::vector<std::thread> crew;
        for (std::size_t t = 0; t < threads; ++t) {
            crew.emplace_back([&] {
                for (std::size_t i = next++; i < count; i = next++) task(order[i]);
            });
        }
        for (std::thread& thread : crew) thread.join();
    };
}

/// A sphere beside a soup, of which some triangles are equal: 96,920 triangles, so many
/// that the builder hands work out, in sets of several pieces.
TestMesh large_mesh() {
    return joined(joined(icosphere(6), random_soup(3, 14'000, 0.05)), copies_of_one_triangle(1000));
}

TEST(BuildBvh, ThreadsAndTheirScheduleDoNotChangeTheResult) {
    const TestMesh mesh = large_mesh();
    for (const Quality quality : kQualities) {
        const Bvh serial = build_bvh(mesh.positions, mesh.triangles, {.quality = quality});
        EXPECT_TRUE(
            same_bytes(serial, build_bvh(mesh.positions, mesh.triangles,
                                         {.parallel_for = threads_for, .quality = quality})));
        for (std::uint32_t threads = 1; threads <= 8; ++threads) {
            auto shuffled = shuffled_on(threads, threads);
            const Bvh parallel = build_bvh(mesh.positions, mesh.triangles,
                                           {.parallel_for = shuffled, .quality = quality});
            EXPECT_TRUE(same_bytes(serial, parallel)) << threads << " threads";
        }
    }
}

// Large sets are cut in pieces, by other code than small ones. find_deep_damage()
// works out anew what every box must hold.
TEST(BuildBvh, BoxesOfLargeModelsHoldTheirTriangles) {
    const TestMesh mesh = large_mesh();
    for (const Quality quality : kQualities) {
        const Bvh bvh = build_bvh(mesh.positions, mesh.triangles, {.quality = quality});
        const AlignedBytes file =
            bake_tiny(mesh.positions, mesh.triangles, bvh, {.double_precision = true});
        EXPECT_FALSE(format::find_deep_damage(file.span()));
    }
}

TEST(BuildBvh, RebuildingIntoOldArraysIsBuilding) {
    const TestMesh mesh = icosphere(4);
    Bvh bvh = build_bvh(fan(700).positions, fan(700).triangles);
    for (const Quality quality : kQualities) {
        rebuild_bvh(bvh, mesh.positions, mesh.triangles, {.quality = quality});
        EXPECT_TRUE(
            same_bytes(bvh, build_bvh(mesh.positions, mesh.triangles, {.quality = quality})));
    }
    rebuild_bvh(bvh, mesh.positions, mesh.triangles, {.bounds = build::BvhBounds::aligned});
    EXPECT_TRUE(bvh.oriented_nodes.empty());
    rebuild_bvh(bvh, {}, {});
    EXPECT_TRUE(same_bytes(bvh, Bvh{}));
}

// The oracle: questions to the hierarchy that other tests hold against brute force.
TEST(BuildBvh, AFastHierarchyGivesTheSameAnswers) {
    const TestMesh soup = random_soup(11, 3000, 0.2);
    const TestMesh ball = icosphere(4);
    const OpenModel best_a = open_tiny(soup, {.double_precision = true});
    const OpenModel fast_a = open_tiny(soup, {.double_precision = true, .quality = Quality::fast});
    const OpenModel best_b = open_tiny(ball, {.double_precision = true});
    const OpenModel fast_b = open_tiny(ball, {.double_precision = true, .quality = Quality::fast});
    std::mt19937 random(5);
    Workspace workspace;
    int hits = 0;
    constexpr int kPoses = 60;
    for (int i = 0; i < kPoses; ++i) {
        const Placement placement = Placement::b_moves(random_pose(random, 2.6));
        const auto expected = all_pairs(best_a.model, best_b.model, placement, workspace);
        EXPECT_EQ(all_pairs(fast_a.model, fast_b.model, placement, workspace), expected);
        EXPECT_EQ(collide({fast_a.model, fast_b.model, placement}, workspace).hit == Answer::yes,
                  !expected.empty());
        hits += expected.empty() ? 0 : 1;
    }
    EXPECT_GE(hits, kPoses * 3 / 10);
    EXPECT_LE(hits, kPoses * 7 / 10);
}

// By hand: one leaf of one flat triangle fills its box; two leaves that share theirs
// count twice; points have no area.
TEST(SurfaceCost, IsTheAreaOfAllBoxesByThatOfTheWhole) {
    const TestMesh one = copies_of_one_triangle(1);
    EXPECT_NEAR(surface_cost(build_bvh(one.positions, one.triangles)), 1, 1e-6);
    const TestMesh copies = copies_of_one_triangle(16);
    EXPECT_NEAR(surface_cost(build_bvh(copies.positions, copies.triangles)), 2, 1e-6);
    const TestMesh point = one_point(16);
    EXPECT_EQ(surface_cost(build_bvh(point.positions, point.triangles)), 0);
    EXPECT_EQ(surface_cost(Bvh{}), 0);
}

TEST(SurfaceCost, IsLittleHigherForAFastHierarchy) {
    const TestMesh sphere = icosphere(6);
    const double best = surface_cost(build_bvh(sphere.positions, sphere.triangles));
    const double fast =
        surface_cost(build_bvh(sphere.positions, sphere.triangles, {.quality = Quality::fast}));
    EXPECT_GT(best, 1);
    EXPECT_LT(best, 1.02 * fast);
    EXPECT_LT(fast, 1.2 * best);
}

TEST(BuildBvh, ThreadsDoNotChangeSweptSpheres) {
    const TestMesh sphere = icosphere(6);
    for (const build::BvhBounds bounds : kSwept) {
        const Bvh one = build_bvh(sphere.positions, sphere.triangles, {.bounds = bounds});
        const Bvh many = build_bvh(sphere.positions, sphere.triangles,
                                   {.parallel_for = threads_for, .bounds = bounds});
        EXPECT_TRUE(same_bytes(one, many));
    }
}

// The ideal leaf is a square patch; turned anyhow, its box has edges of one side's
// length on average. A tree that ignored places would be 30 times worse.
TEST(BuildBvh, LeavesOfASphereAreCompact) {
    const TestMesh sphere = icosphere(5);  // 20,480 triangles
    const Bvh bvh = build_bvh(sphere.positions, sphere.triangles);
    const BvhShape shape = format::bvh_shape(static_cast<std::uint32_t>(bvh.order.size()));
    double edges = 0;
    for (std::uint32_t leaf = 0; leaf < shape.leaf_count; ++leaf) {
        const format::BvhNode& node = bvh.nodes[shape.first[0] + leaf / format::kBvhWidth];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            edges += node.upper[axis][leaf % format::kBvhWidth] -
                     node.lower[axis][leaf % format::kBvhWidth];
        }
    }
    // Eight triangles cover 4 pi 8 / 20480 = 0.0049 of area: a patch of 0.07 x 0.07.
    const double mean_edge = std::ldexp(edges / (3.0 * shape.leaf_count), -bvh.frame.exponent);
    EXPECT_LT(mean_edge, 2 * 0.07);
}

}  // namespace
}  // namespace cdprep::test
