// SPDX-License-Identifier: MIT
#include "cdprep/cells/build_adaptive_octree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "cdprep/cells/build_octree.h"
#include "support/aligned_bytes.h"
#include "support/exact_box.h"
#include "support/meshes.h"
#include "support/run_threads.h"

namespace cdprep::build {
namespace {

using format::kInnerNode;
using format::kSharedReference;
using format::SplitRule;
using test::Double3;
using test::TestMesh;

constexpr std::array<SplitRule, 2> kRules = {SplitRule::median, SplitRule::surface_area};

Corners corners_of(const TestMesh& mesh, std::size_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle].vertex;
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

AdaptiveOctree tree_of(const TestMesh& mesh, std::uint32_t level, std::uint32_t threshold,
                       SplitRule rule) {
    return build_adaptive_octree(mesh.positions, mesh.triangles,
                                 {.level = level, .threshold = threshold, .rule = rule});
}

/// A node with what follows from those above it.
struct Placed {
    Box3 box;
    std::uint32_t level;
    std::uint32_t node;
};

Box3 part_of(const Box3& box, const Double3& s, std::uint32_t child) {
    const auto [x, y, z] = std::array{child & 1, child & 2, child & 4};
    const auto& [lower, upper] = box;
    return {{x != 0 ? s.x : lower.x, y != 0 ? s.y : lower.y, z != 0 ? s.z : lower.z},
            {x != 0 ? upper.x : s.x, y != 0 ? upper.y : s.y, z != 0 ? upper.z : s.z}};
}

/// Whether the part lies above a plane along an axis that is not divided: none at all.
bool is_no_part(const Box3& box, const Double3& s, std::uint32_t child) {
    return ((child & 1) != 0 && s.x == box.upper.x) || ((child & 2) != 0 && s.y == box.upper.y) ||
           ((child & 4) != 0 && s.z == box.upper.z);
}

/// All nodes; checks that children are where the format says. Calls missing(box) for
/// every part of a divided cell that has no node.
std::vector<Placed> placed_nodes(const AdaptiveOctree& tree,
                                 const std::function<void(const Box3&)>& missing) {
    std::vector<Placed> nodes;
    if (tree.nodes.empty()) return nodes;
    nodes.push_back({{tree.tree.lower, tree.tree.upper}, 0, 0});
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Placed at = nodes[i];
        const format::AdaptiveOctreeNode& node = tree.nodes[at.node];
        if ((node.count & kInnerNode) == 0) continue;
        EXPECT_EQ(node.first, nodes.size());
        for (std::uint32_t child = 0; child < 8; ++child) {
            const bool is_there = ((node.count >> child) & 1) != 0;
            const Box3 box = part_of(at.box, node.split, child);
            if (is_no_part(at.box, node.split, child)) {
                EXPECT_FALSE(is_there);
            } else if (!is_there) {
                missing(box);
            } else {
                nodes.push_back({box, at.level + 1, static_cast<std::uint32_t>(nodes.size())});
            }
        }
    }
    EXPECT_EQ(nodes.size(), tree.nodes.size());
    return nodes;
}

std::vector<std::uint32_t> touching(const TestMesh& mesh, const Box3& box) {
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (test::touches_box_by_cutting(corners_of(mesh, i), box)) {
            found.push_back(static_cast<std::uint32_t>(i));
        }
    }
    return found;
}

std::vector<std::uint32_t> listed(const AdaptiveOctree& tree, std::uint32_t node) {
    const auto first = tree.references.begin() + tree.nodes[node].first;
    std::vector<std::uint32_t> list(first, first + tree.nodes[node].count);
    for (std::uint32_t& reference : list) reference &= ~kSharedReference;
    return list;
}

/// Everything that the format says of lists, by brute force in exact numbers.
void expect_right_lists(const TestMesh& mesh, const AdaptiveOctree& tree) {
    const auto nodes =
        placed_nodes(tree, [&](const Box3& box) { EXPECT_TRUE(touching(mesh, box).empty()); });
    std::vector<std::uint32_t> times(mesh.triangles.size());
    std::size_t next = 0;
    for (const Placed& at : nodes) {
        const format::AdaptiveOctreeNode& node = tree.nodes[at.node];
        if ((node.count & kInnerNode) != 0) continue;
        EXPECT_EQ(node.first, next);
        EXPECT_EQ(node.split, (Double3{0, 0, 0}));
        next += node.count;
        EXPECT_GT(node.count, 0U);
        const auto list = listed(tree, at.node);
        EXPECT_EQ(list, touching(mesh, at.box));
        for (const std::uint32_t triangle : list) ++times[triangle];
    }
    EXPECT_EQ(next, tree.references.size());
    for (const std::uint32_t reference : tree.references) {
        const bool shared = (reference & kSharedReference) != 0;
        EXPECT_EQ(shared, times[reference & ~kSharedReference] > 1);
    }
    EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](auto n) { return n > 0; }));
}

// The oracle cuts triangles at the planes, in rational numbers.
TEST(BuildAdaptiveOctree, LeavesListWhatTouchesTheirClosedBoxes) {
    std::size_t shared = 0;
    std::size_t all = 0;
    for (std::uint32_t seed = 1; seed <= 2; ++seed) {
        for (const SplitRule rule : kRules) {
            for (const TestMesh& mesh :
                 {test::random_soup(seed, 30, 0.6), test::coarse_grid_soup(seed, 40, 2)}) {
                const AdaptiveOctree tree = tree_of(mesh, 3, 4, rule);
                expect_right_lists(mesh, tree);
                for (const std::uint32_t r : tree.references) shared += r >> 31;
                all += tree.references.size();
            }
        }
    }
    EXPECT_GT(shared, all * 3 / 10);
}

double coordinate(const Double3& p, std::size_t axis) {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// The cells of a tree that are divided, with the triangles that touch them.
template <class Body>
void for_divided(const TestMesh& mesh, const AdaptiveOctree& tree, Body body) {
    for (const Placed& at : placed_nodes(tree, [](const Box3&) {})) {
        const format::AdaptiveOctreeNode& node = tree.nodes[at.node];
        if ((node.count & kInnerNode) != 0) body(at, node, touching(mesh, at.box));
    }
}

// By sorting all middles.
TEST(BuildAdaptiveOctree, MedianRuleDividesAtTheMedianOfTheMiddles) {
    std::size_t compared = 0;
    const TestMesh mesh = test::random_soup(7, 60, 0.4);
    for_divided(mesh, tree_of(mesh, 2, 8, SplitRule::median),
                [&](const Placed& at, const auto& node, const auto& list) {
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        std::vector<double> middles;
                        const double from = coordinate(at.box.lower, axis);
                        const double to = coordinate(at.box.upper, axis);
                        for (const std::uint32_t triangle : list) {
                            const Box3 box = box_around(corners_of(mesh, triangle));
                            const double lower = std::max(from, coordinate(box.lower, axis));
                            const double upper = std::min(to, coordinate(box.upper, axis));
                            middles.push_back(lower + (upper - lower) / 2);
                        }
                        std::sort(middles.begin(), middles.end());
                        EXPECT_EQ(coordinate(node.split, axis), middles[middles.size() / 2]);
                        ++compared;
                    }
                });
    EXPECT_GT(compared, 10U);
}

double half_area(const Box3& box) {
    const double x = box.upper.x - box.lower.x;
    const double y = box.upper.y - box.lower.y;
    const double z = box.upper.z - box.lower.z;
    return x * y + y * z + z * x;
}

// By trying each plane: none is cheaper by more than rounding.
TEST(BuildAdaptiveOctree, SurfaceAreaRuleDividesAtTheCheapestOfThePlanes) {
    std::size_t compared = 0;
    const TestMesh mesh = test::random_soup(8, 60, 0.4);
    for_divided(
        mesh, tree_of(mesh, 2, 8, SplitRule::surface_area),
        [&](const Placed& at, const auto& node, const auto& list) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto cost = [&](double plane) {
                    Box3 below = at.box;
                    Box3 above = at.box;
                    (axis == 0 ? below.upper.x : axis == 1 ? below.upper.y : below.upper.z) = plane;
                    (axis == 0 ? above.lower.x : axis == 1 ? above.lower.y : above.lower.z) = plane;
                    double sum = 0;
                    for (const std::uint32_t triangle : list) {
                        const Box3 box = box_around(corners_of(mesh, triangle));
                        if (coordinate(box.lower, axis) <= plane) sum += half_area(below);
                        if (coordinate(box.upper, axis) >= plane) sum += half_area(above);
                    }
                    return sum;
                };
                const double from = coordinate(at.box.lower, axis);
                const double to = coordinate(at.box.upper, axis);
                double least = cost(from + (to - from) / 2);
                for (int i = 1; i < 16; ++i)
                    least = std::min(least, cost(from + (to - from) * i / 16));
                EXPECT_NEAR(cost(coordinate(node.split, axis)), least, 1e-9 * least);
                ++compared;
            }
        });
    EXPECT_GT(compared, 10U);
}

// A sheet has no depth to divide; four children at most, as a quadtree has.
TEST(BuildAdaptiveOctree, FlatAxesStayWhole) {
    const TestMesh sheet = test::grid_sheet(7, 9);
    for (const SplitRule rule : kRules) {
        const AdaptiveOctree tree = tree_of(sheet, 3, 4, rule);
        expect_right_lists(sheet, tree);
        std::size_t divided = 0;
        for (const format::AdaptiveOctreeNode& node : tree.nodes) {
            if ((node.count & kInnerNode) == 0) continue;
            EXPECT_EQ(node.split.z, 0);
            EXPECT_EQ(node.count & 0xf0, 0U);
            ++divided;
        }
        EXPECT_GT(divided, 4U);
    }
}

// By hand: nothing tells equal triangles apart, nor those that meet in a point which is
// all of the cell.
TEST(BuildAdaptiveOctree, SetsThatNothingSeparatesStayTogether) {
    const TestMesh copies = test::copies_of_one_triangle(50);
    TestMesh point;
    point.positions = {{3, 4, 5}};
    point.triangles.assign(50, {{0, 0, 0}});
    for (const SplitRule rule : kRules) {
        for (const TestMesh& mesh : {copies, point}) {
            const AdaptiveOctree tree = tree_of(mesh, 21, 1, rule);
            EXPECT_EQ(tree.nodes.size(), 1U);
            EXPECT_EQ(tree.references.size(), 50U);
            EXPECT_EQ(tree.nodes.at(0).count, 50U);
        }
    }
}

// Most triangles lie flat on one face, so that the median is on the border.
TEST(BuildAdaptiveOctree, AMedianOnTheBorderGivesWayToTheMiddle) {
    TestMesh mesh =
        test::joined(test::grid_sheet(6, 6), test::moved_by(test::icosphere(0), 1, {3, 3, 2}));
    const AdaptiveOctree tree = tree_of(mesh, 3, 4, SplitRule::median);
    expect_right_lists(mesh, tree);
    const double top = tree.tree.upper.z;
    EXPECT_EQ(tree.nodes.at(0).split.z, top / 2);
}

TEST(BuildAdaptiveOctree, NothingGivesNothing) {
    const AdaptiveOctree tree = build_adaptive_octree({}, {});
    EXPECT_TRUE(tree.nodes.empty());
    EXPECT_TRUE(tree.references.empty());
    EXPECT_EQ(tree.tree.lower, (Double3{0, 0, 0}));
    EXPECT_EQ(tree.tree.upper, (Double3{0, 0, 0}));
}

TEST(BuildAdaptiveOctree, LevelAndThresholdBound) {
    const TestMesh mesh = test::icosphere(3);
    for (const SplitRule rule : kRules) {
        EXPECT_EQ(tree_of(mesh, 0, 1, rule).nodes.size(), 1U);
        EXPECT_EQ(tree_of(mesh, 5, 1281, rule).nodes.size(), 1U);
        EXPECT_GT(tree_of(mesh, 5, 1280, rule).nodes.size(), 1U);
        for (const std::uint32_t level : {1U, 2U, 3U}) {
            const AdaptiveOctree tree = tree_of(mesh, level, 20, rule);
            std::uint32_t deepest = 0;
            for (const Placed& at : placed_nodes(tree, [](const Box3&) {})) {
                const format::AdaptiveOctreeNode& node = tree.nodes[at.node];
                const bool inner = (node.count & kInnerNode) != 0;
                deepest = std::max(deepest, at.level);
                EXPECT_TRUE(inner || node.count < 20 || at.level == level);
            }
            EXPECT_EQ(deepest, level);
        }
    }
}

// Powers of two change no sum, no product and no comparison, as long as nothing leaves
// the range of double.
TEST(BuildAdaptiveOctree, ScaleChangesNothing) {
    const TestMesh mesh = test::in_floats(test::random_soup(9, 200, 0.5));
    for (const SplitRule rule : kRules) {
        const AdaptiveOctree tree = tree_of(mesh, 4, 4, rule);
        for (const int exponent : {-990, -500, 500, 998}) {
            const double scale = std::ldexp(1.0, exponent);
            const AdaptiveOctree scaled =
                tree_of(test::moved_by(mesh, scale, {0, 0, 0}), 4, 4, rule);
            EXPECT_EQ(scaled.references, tree.references) << exponent;
            ASSERT_EQ(scaled.nodes.size(), tree.nodes.size());
            for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
                EXPECT_EQ(scaled.nodes[i].count, tree.nodes[i].count);
                EXPECT_EQ(scaled.nodes[i].split.y, scale * tree.nodes[i].split.y);
            }
        }
    }
}

TEST(BuildAdaptiveOctree, FarFromTheOriginAndTinyIsRightToo) {
    for (const SplitRule rule : kRules) {
        for (const TestMesh& mesh :
             {test::moved_by(test::random_soup(3, 40, 0.6), 1e-3, {1e6, -1e6, 1e6}),
              test::moved_by(test::random_soup(4, 40, 0.6), 1e-9, {1e6, 1e6, 0}),
              test::moved_by(test::random_soup(5, 40, 0.6), 0x1p-1060, {0, 0, 0}),
              test::geometric_progression(40)}) {
            expect_right_lists(mesh, tree_of(mesh, 3, 3, rule));
        }
    }
}

// A triangle through everything has 4^l cells at level l.
TEST(BuildAdaptiveOctree, TreesEndBeforeTheyFillTheMemory) {
    const TestMesh mesh = test::random_soup(6, 20, 2);
    const AdaptiveOctree tree = tree_of(mesh, 21, 2, SplitRule::median);
    const std::size_t most = kMostFreeReferences + kMostReferencesPerTriangle * 20;
    EXPECT_LE(tree.references.size(), most);
    EXPECT_GT(tree.references.size(), most / 16);
}

// Beyond what is free of charge, each triangle has its share.
TEST(BuildAdaptiveOctree, ManyTrianglesHaveRoomForManyReferences) {
    const TestMesh mesh = test::random_soup(6, 100'000, 0.27);
    const AdaptiveOctree tree = tree_of(mesh, 6, 2, SplitRule::median);
    EXPECT_GT(tree.references.size(), kMostFreeReferences + kMostReferencesPerTriangle + 100'000);
    EXPECT_LE(tree.references.size(), kMostFreeReferences + kMostReferencesPerTriangle * 100'000);
}

// Large enough for several pieces of one cell.
TEST(BuildAdaptiveOctree, AnyNumberOfThreadsGivesTheSameBytes) {
    const TestMesh mesh = test::joined(test::icosphere(4), test::random_soup(2, 3000, 0.3));
    for (const SplitRule rule : kRules) {
        const AdaptiveOctree tree = tree_of(mesh, 5, 10, rule);
        for (std::size_t threads = 1; threads <= 8; ++threads) {
            const auto run = [threads](std::size_t count, Task task) {
                for (std::size_t first = 0; first < count; first += threads) {
                    test::run_threads(std::min(threads, count - first),
                                      [&](std::size_t i) { task(first + i); });
                }
            };
            const AdaptiveOctree again = build_adaptive_octree(
                mesh.positions, mesh.triangles,
                {.parallel_for = run, .level = 5, .threshold = 10, .rule = rule});
            EXPECT_EQ(std::memcmp(&again.tree, &tree.tree, sizeof tree.tree), 0);
            EXPECT_TRUE(test::same_bytes(again.nodes, tree.nodes)) << threads;
            EXPECT_TRUE(test::same_bytes(again.references, tree.references)) << threads;
        }
        // Backwards, which no scheduler would do.
        const auto backwards = [](std::size_t count, Task task) {
            while (count > 0) task(--count);
        };
        const AdaptiveOctree again = build_adaptive_octree(
            mesh.positions, mesh.triangles,
            {.parallel_for = backwards, .level = 5, .threshold = 10, .rule = rule});
        EXPECT_TRUE(test::same_bytes(again.nodes, tree.nodes));
        EXPECT_TRUE(test::same_bytes(again.references, tree.references));
    }
}

}  // namespace
}  // namespace cdprep::build
