// SPDX-License-Identifier: MIT
#include "cdprep/build_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <thread>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "cdprep/pose.h"
#include "support/exact_rational.h"
#include "support/meshes.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

using build::build_bvh;
using build::Bvh;
using format::BvhShape;

std::vector<TestMesh> awkward_meshes() {
    return {TestMesh{},
            fan(1),
            fan(9),
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

ExactNumber in_frame(double x, double origin, std::int32_t exponent) {
    ExactNumber value = ExactNumber(x) - ExactNumber(origin);
    // Two steps: neither power of two leaves the range of double.
    value = value * ExactNumber(std::ldexp(1.0, exponent / 2));
    return value * ExactNumber(std::ldexp(1.0, exponent - exponent / 2));
}

struct Range {
    std::uint32_t first, last;
};

/// Triangles in tree order below box `box` of node `node` of a level.
Range below(std::uint32_t level, std::uint32_t node, std::uint32_t box, std::size_t count) {
    std::uint64_t size = format::kBvhWidth;
    for (std::uint32_t l = 0; l < level; ++l) size *= format::kBvhWidth;
    const std::uint64_t first = (std::uint64_t{node} * format::kBvhWidth + box) * size;
    return {static_cast<std::uint32_t>(std::min<std::uint64_t>(first, count)),
            static_cast<std::uint32_t>(std::min<std::uint64_t>(first + size, count))};
}

/// Boxes must hold their triangles in exact arithmetic.
void expect_boxes_hold(const TestMesh& mesh, const Bvh& bvh) {
    const BvhShape shape = format::bvh_shape(static_cast<std::uint32_t>(bvh.order.size()));
    const double origin[3] = {bvh.frame.origin.x, bvh.frame.origin.y, bvh.frame.origin.z};
    for (std::uint32_t level = 0; level < shape.levels; ++level) {
        for (std::uint32_t n = 0; n < shape.count[level]; ++n) {
            const format::BvhNode& node = bvh.nodes[shape.first[level] + n];
            for (std::uint32_t box = 0; box < shape.used_boxes(level, n); ++box) {
                const Range range = below(level, n, box, bvh.order.size());
                ASSERT_LT(range.first, range.last);
                for (std::uint32_t i = range.first; i < range.last; ++i) {
                    for (const std::uint32_t v : mesh.triangles[bvh.order[i]].vertex) {
                        const Double3& p = mesh.positions[v];
                        const double x[3] = {p.x, p.y, p.z};
                        for (std::size_t axis = 0; axis < 3; ++axis) {
                            const ExactNumber at =
                                in_frame(x[axis], origin[axis], bvh.frame.exponent);
                            ASSERT_TRUE(ExactNumber(node.lower[axis][box]) <= at);
                            ASSERT_TRUE(at <= ExactNumber(node.upper[axis][box]));
                        }
                    }
                }
            }
        }
    }
}

TEST(BuildBvh, EveryBoxHoldsItsTrianglesInExactArithmetic) {
    for (const TestMesh& mesh : awkward_meshes()) {
        expect_boxes_hold(mesh, build_bvh(mesh.positions, mesh.triangles));
    }
}

// Leaves hold the corners, oriented boxes the vertices: find_deep_damage() works
// that out anew from positions and triangles.
TEST(BuildBvh, LeavesAndOrientedBoxesHoldTheirTriangles) {
    for (const TestMesh& mesh : awkward_meshes()) {
        for (const bool double_precision : {false, true}) {
            if (!double_precision && !all_floats(mesh)) continue;
            const AlignedBytes file =
                bake_tiny(mesh.positions, mesh.triangles, {.double_precision = double_precision});
            const auto damage = format::find_deep_damage(file.span());
            EXPECT_FALSE(damage) << format::section_name(damage->section) << " " << damage->at;
        }
    }
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
                for (std::uint32_t n = 0; n < shape.count[level]; ++n) {
                    const format::SweptNode& node = bvh.swept_nodes[shape.first[level] + n];
                    for (std::uint32_t box = 0; box < shape.used_boxes(level, n); ++box) {
                        const Range range = below(level, n, box, count);
                        for (std::uint32_t i = range.first; i < range.last; ++i) {
                            for (const std::uint32_t v : mesh.triangles[bvh.order[i]].vertex) {
                                const Double3& p = mesh.positions[v];
                                const std::array<ExactNumber, 3> at = {
                                    in_frame(p.x, origin[0], bvh.frame.exponent),
                                    in_frame(p.y, origin[1], bvh.frame.exponent),
                                    in_frame(p.z, origin[2], bvh.frame.exponent)};
                                ASSERT_TRUE(swept_sphere_holds(node, box, at));
                            }
                        }
                    }
                }
            }
        }
    }
}

// find_deep_damage() works it out anew from positions and triangles.
TEST(BuildBvh, SweptSpheresPassTheDeepCheck) {
    for (const TestMesh& mesh : awkward_meshes()) {
        for (const build::BvhBounds bounds : kSwept) {
            for (const bool double_precision : {false, true}) {
                if (!double_precision && !all_floats(mesh)) continue;
                const AlignedBytes file =
                    bake_tiny(mesh.positions, mesh.triangles,
                              {.double_precision = double_precision, .bounds = bounds});
                const auto damage = format::find_deep_damage(file.span());
                EXPECT_FALSE(damage) << format::section_name(damage->section) << " " << damage->at;
            }
        }
    }
}

// By hand: the sheet lies in one plane and is longer than wide.
TEST(BuildBvh, SweptSpheresOfATurnedSheetAreTight) {
    TestMesh sheet = grid_sheet(4, 16);  // 128 triangles: two levels
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {0, 0, 0}).value();
    for (Double3& p : sheet.positions) p = moved(pose, p);
    const auto root_with = [&](build::BvhBounds bounds) {
        return build_bvh(sheet.positions, sheet.triangles, {.bounds = bounds});
    };
    const Bvh points = root_with(build::BvhBounds::swept_points);
    const Bvh lines = root_with(build::BvhBounds::swept_lines);
    const Bvh rectangles = root_with(build::BvhBounds::swept_rectangles);
    EXPECT_EQ(rectangles.swept_kind, format::SweptKind::rectangle);
    EXPECT_EQ(lines.swept_kind, format::SweptKind::line);
    for (std::size_t node = 0; node < points.swept_nodes.size(); ++node) {
        for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
            const double ball = points.swept_nodes[node].radius[box];
            if (ball == 0) continue;  // unused
            const double capsule = lines.swept_nodes[node].radius[box];
            EXPECT_LT(rectangles.swept_nodes[node].radius[box], 1e-6);
            EXPECT_LT(capsule, ball * (1 + 1e-5));
            EXPECT_EQ(points.swept_nodes[node].side[0].half[box], 0);
            EXPECT_EQ(lines.swept_nodes[node].side[1].half[box], 0);
        }
    }
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
    for (Double3& p : sheet.positions) p = moved(pose, p);
    const Bvh bvh = build_bvh(sheet.positions, sheet.triangles);
    ASSERT_FALSE(bvh.oriented_nodes.empty());
    for (const format::OrientedNode& node : bvh.oriented_nodes) {
        for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
            if (node.half[0][box] < 0) continue;  // unused
            EXPECT_LT(node.half[0][box], 1e-4F * node.half[2][box]);
        }
    }
}

TEST(BuildBvh, TheOrderNamesEveryTriangleOnce) {
    for (const TestMesh& mesh : awkward_meshes()) {
        std::vector<std::uint32_t> order = build_bvh(mesh.positions, mesh.triangles).order;
        std::sort(order.begin(), order.end());
        std::vector<std::uint32_t> all(mesh.triangles.size());
        std::iota(all.begin(), all.end(), 0U);
        EXPECT_EQ(order, all);
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

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Every body on a thread of its own, last first.
void threads_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    std::vector<std::thread> threads;
    for (std::size_t i = count; i-- > 0;) threads.emplace_back(body, i);
    for (std::thread& thread : threads) thread.join();
}

// Large enough that the builder hands work out.
TEST(BuildBvh, ThreadsDoNotChangeTheResult) {
    const TestMesh sphere = icosphere(6);
    const Bvh serial = build_bvh(sphere.positions, sphere.triangles);
    const Bvh parallel = build_bvh(sphere.positions, sphere.triangles, {threads_for});
    EXPECT_EQ(serial.order, parallel.order);
    ASSERT_EQ(serial.nodes.size(), parallel.nodes.size());
    EXPECT_TRUE(same_bytes(serial.nodes, parallel.nodes));
    EXPECT_TRUE(same_bytes(serial.leaves, parallel.leaves));
    EXPECT_TRUE(same_bytes(serial.oriented_nodes, parallel.oriented_nodes));
    for (const build::BvhBounds bounds : kSwept) {
        const Bvh one = build_bvh(sphere.positions, sphere.triangles, {.bounds = bounds});
        const Bvh many = build_bvh(sphere.positions, sphere.triangles,
                                   {.parallel_for = threads_for, .bounds = bounds});
        EXPECT_TRUE(same_bytes(one.swept_nodes, many.swept_nodes));
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
