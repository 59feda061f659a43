// SPDX-License-Identifier: MIT
#include "cdprep/cells/build_octree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include "cells/octree_codes.h"
#include "support/aligned_bytes.h"
#include "support/exact_box.h"
#include "support/meshes.h"
#include "support/run_threads.h"

namespace cdprep::test {
namespace {

using build::build_octree;
using build::Octree;
using build::OctreeOptions;
using format::kInnerNode;
using format::kSharedReference;
using format::OctreeNode;

bool is_inner(const OctreeNode& node) {
    return (node.count & kInnerNode) != 0;
}

Box3 box_of(const format::OctreeGrid& grid, std::uint64_t key) {
    return octree_box(grid, octree_place(key), level_of(key));
}

Corners corners_of(const TestMesh& mesh, std::size_t i) {
    const auto& v = mesh.triangles[i].vertex;
    return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

/// Whether the triangle and the box have a common point: exact.
bool touches(const Corners& t, const Box3& box) {
    return overlap(box_around(t), box) && touches_box_by_cutting(t, box);
}

std::vector<std::uint32_t> touching(const TestMesh& mesh, const Box3& box) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (touches(corners_of(mesh, i), box)) found.push_back(i);
    }
    return found;
}

std::vector<std::uint32_t> listed(const Octree& octree, const OctreeNode& leaf) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
        found.push_back(octree.references[leaf.first + i] & ~kSharedReference);
    }
    return found;
}

/// By brute force over all leaves and all triangles.
void expect_exact_leaves(const TestMesh& mesh, const Octree& octree) {
    for (const OctreeNode& node : octree.nodes) {
        if (is_inner(node)) continue;
        const auto expected = touching(mesh, box_of(octree.grid, node.key));
        ASSERT_EQ(listed(octree, node), expected) << "leaf " << node.key;
        ASSERT_FALSE(expected.empty());
    }
}

/// Children that are not there are touched by nothing.
void expect_empty_where_no_child_is(const TestMesh& mesh, const Octree& octree) {
    for (const OctreeNode& node : octree.nodes) {
        if (!is_inner(node)) continue;
        for (std::uint64_t child = 0; child < 8; ++child) {
            if ((node.count >> child & 1) != 0) continue;
            const Box3 box = box_of(octree.grid, node.key << 3 | child);
            ASSERT_TRUE(touching(mesh, box).empty()) << "child " << child << " of " << node.key;
        }
    }
}

/// A reference is marked exactly when its triangle stands in another leaf too.
void expect_shared_marks(const Octree& octree) {
    std::map<std::uint32_t, int> leaves;
    for (const std::uint32_t r : octree.references) ++leaves[r & ~kSharedReference];
    for (const std::uint32_t r : octree.references) {
        ASSERT_EQ((r & kSharedReference) != 0, leaves[r & ~kSharedReference] > 1);
    }
}

/// What format/octree.h says of nodes: one behind the other, level by level.
void expect_shape(const Octree& octree) {
    std::uint64_t next_child = 1;
    std::uint64_t next_reference = 0;
    for (std::size_t i = 0; i < octree.nodes.size(); ++i) {
        const OctreeNode& node = octree.nodes[i];
        if (i > 0) {
            ASSERT_LT(octree.nodes[i - 1].key, node.key);
        }
        ASSERT_LE(level_of(node.key), octree.grid.level);
        if (!is_inner(node)) {
            ASSERT_EQ(node.first, next_reference);
            ASSERT_GT(node.count, 0U);
            next_reference += node.count;
            continue;
        }
        ASSERT_EQ(node.first, next_child);
        ASSERT_EQ(node.count & ~(kInnerNode | 0xffU), 0U);
        for (std::uint64_t child = 0; child < 8; ++child) {
            if ((node.count >> child & 1) == 0) continue;
            ASSERT_LT(next_child, octree.nodes.size());
            ASSERT_EQ(octree.nodes[next_child].key, node.key << 3 | child);
            ++next_child;
        }
    }
    EXPECT_EQ(next_child, std::max<std::uint64_t>(octree.nodes.size(), 1));
    EXPECT_EQ(next_reference, octree.references.size());
}

/// The triangles below a node, each once.
std::vector<std::uint32_t> below(const Octree& octree, const OctreeNode& node) {
    if (!is_inner(node)) return listed(octree, node);
    std::vector<std::uint32_t> all;
    for (int i = 0; i < std::popcount(node.count & 0xff); ++i) {
        const auto some = below(octree, octree.nodes[node.first + static_cast<std::size_t>(i)]);
        all.insert(all.end(), some.begin(), some.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

/// A node is divided exactly when it has `threshold` triangles and a level is left.
void expect_threshold(const Octree& octree) {
    for (const OctreeNode& node : octree.nodes) {
        const bool full = below(octree, node).size() >= octree.grid.threshold;
        ASSERT_EQ(is_inner(node), full && level_of(node.key) < octree.grid.level);
    }
}

void expect_right(const TestMesh& mesh, const OctreeOptions& options) {
    const Octree octree = build_octree(mesh.positions, mesh.triangles, options);
    expect_shape(octree);
    expect_exact_leaves(mesh, octree);
    expect_empty_where_no_child_is(mesh, octree);
    expect_shared_marks(octree);
    expect_threshold(octree);
}

/// A triangle in every plane of the axes' middle, quarter and finest cells, corners,
/// edges and whole faces on planes; inside a cube that fixes the grid.
TestMesh on_cell_planes() {
    TestMesh mesh = unit_cube();
    const format::OctreeGrid grid = build_octree(mesh.positions, mesh.triangles).grid;
    const std::array<std::uint32_t, 4> at = {1U << 20, 1U << 19, 3U << 19, (1U << 20) + 3};
    const std::array<double, 3> origin = {grid.origin.x, grid.origin.y, grid.origin.z};
    const auto plane = [&](std::size_t axis, std::uint32_t i) {
        return octree_plane(origin[axis], grid.step, i);
    };
    const auto add = [&](const Double3& a, const Double3& b, const Double3& c) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c});
        mesh.triangles.push_back({{first, first + 1, first + 2}});
    };
    for (const std::uint32_t i : at) {
        const double x = plane(0, i), y = plane(1, i), z = plane(2, i);
        add({x, 0.3, 0.3}, {x, 0.4, 0.3}, {x, 0.3, 0.4});
        add({0.3, y, 0.3}, {0.9, y, 0.3}, {0.3, y, 0.9});
        add({0.3, 0.3, z}, {0.4, 0.3, z}, {0.3, 0.4, z});
        add({x, y, 0.1}, {x, y, 0.2}, {0.1, 0.2, 0.3});    // an edge on an edge of cells
        add({x, y, z}, {0.1, 0.2, 0.3}, {0.2, 0.1, 0.3});  // a corner on a corner
        add({x, y, z}, {x, y, z}, {x, y, z});              // a point there
        add({x, y, 0.1}, {x, y, 0.9}, {x, y, 0.5});        // a segment there
        add({x + (y - plane(1, 1 << 20)), y, 0.6}, {x, y + 0.125, 0.6}, {x - 0.125, y, 0.7});
    }
    return mesh;
}

/// Unconnected copies of one large triangle through everything, and an icosphere.
TestMesh big_and_small() {
    TestMesh mesh = icosphere(2);
    for (int i = 0; i < 3; ++i) {
        const double d = 0.1 * i;
        mesh = joined(mesh, {{{10, -10 + d, 0}, {-10, 0, 10}, {0, 10, -10 - d}}, {{{0, 1, 2}}}});
    }
    return mesh;
}

TestMesh scaled_along_z(TestMesh mesh, double factor) {
    for (Double3& p : mesh.positions) p.z *= factor;
    return mesh;
}

std::vector<TestMesh> hard_meshes() {
    return {unit_cube(),
            fan(40),
            icosphere(2),
            on_cell_planes(),
            big_and_small(),
            copies_of_one_triangle(50),
            coarse_grid_soup(3, 40, 4),
            random_soup(11, 60, 0.5),
            moved_by(icosphere(2), 1e-3, {1e6, -1e6, 1e6}),  // B10
            scaled_along_z(icosphere(2), 1e-30),             // B10
            scaled_along_z(grid_sheet(7, 9), 0),             // B11
            {{{3, -2, 0.5}, {3, -2, 0.5}, {3, -2, 0.5}}, {{{0, 1, 2}}, {{0, 1, 2}}}},
            {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{{0, 1, 2}}}},
            {{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}, {{{0, 1, 2}}, {{0, 0, 1}}}},
            geometric_progression(60),
            moved_by(icosphere(1), 0x1p-1000, {}),
            moved_by(icosphere(1), 0x1p-1060, {}),
            moved_by(unit_cube(), 4.652122e-317, {}),  // a share of it rounds down by percents
            moved_by(icosphere(1), 0x1p999, {}),
            moved_by(unit_cube(), 0x1p999, {-0x1p998, -0x1p999, 0})};
}

TEST(BuildOctree, EveryLeafListsExactlyTheTrianglesThatTouchItsClosedCell) {
    for (const TestMesh& mesh : hard_meshes()) {
        for (const OctreeOptions& options :
             {OctreeOptions{}, OctreeOptions{.level = 0}, OctreeOptions{.level = 1},
              OctreeOptions{.level = 4, .threshold = 6},
              OctreeOptions{.level = 21, .threshold = 90}}) {
            SCOPED_TRACE(testing::Message()
                         << mesh.triangles.size() << " triangles, level " << options.level);
            expect_right(mesh, options);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(BuildOctree, ListsAreRightForTenThousandTriangles) {
    const TestMesh soup = random_soup(5, 10'000, 0.02);
    expect_right(soup, {.level = 3});
    expect_right(soup, {.level = 6, .threshold = 40});
}

// Points are in one cell or, on planes, in several; the deepest level takes all 63 bits.
TEST(BuildOctree, LevelTwentyOneIsReachedAndRight) {
    TestMesh mesh = moved_by(icosphere(1), 1e-7, {0.3, 0.4, 0.5});
    mesh = joined(mesh, {{{-1, -1, -1}, {2, 2, 2}}, {{{0, 0, 0}}, {{1, 1, 1}}}});
    const Octree octree = build_octree(mesh.positions, mesh.triangles, {.level = 21});
    EXPECT_EQ(level_of(octree.nodes.back().key), 21U);
    EXPECT_GE(octree.nodes.back().key, std::uint64_t{1} << 63);
    expect_right(mesh, {.level = 21});
}

TEST(BuildOctree, HasNoNodesWithoutTriangles) {
    const Octree octree = build_octree({}, {}, {});
    EXPECT_TRUE(octree.nodes.empty());
    EXPECT_TRUE(octree.references.empty());
    EXPECT_TRUE(octree.leaf_codes.empty());
    EXPECT_GT(octree.grid.step, 0);
    EXPECT_TRUE(std::all_of(octree.top.begin(), octree.top.end(), [](auto n) { return n == 0; }));
}

TEST(BuildOctree, PlanesRiseStrictlyAndTheRootReachesMoreThanAStepBeyond) {
    for (const TestMesh& mesh : hard_meshes()) {
        const format::OctreeGrid grid =
            build_octree(mesh.positions, mesh.triangles, {.level = 0}).grid;
        int exponent = 0;
        const double bits = std::ldexp(std::frexp(grid.step, &exponent), 32);
        EXPECT_EQ(bits, std::floor(bits));
        for (const auto axis : {&Double3::x, &Double3::y, &Double3::z}) {
            const double origin = grid.origin.*axis;
            for (std::uint32_t i = 0; i < kOctreeSteps; i += i < 4096 ? 1 : 997) {
                ASSERT_LT(octree_plane(origin, grid.step, i),
                          octree_plane(origin, grid.step, i + 1));
            }
            for (const Double3& p : mesh.positions) {
                ASSERT_LT(octree_plane(origin, grid.step, 1), p.*axis);
                ASSERT_GT(octree_plane(origin, grid.step, kOctreeSteps - 1), p.*axis);
            }
        }
    }
}

/// Hands the tasks of a build to this many threads, the last ones first.
struct SomeThreads {
    std::size_t threads;
    void operator()(std::size_t count, Task task) const {
        run_threads(threads, [&](std::size_t thread) {
            for (std::size_t i = count; i-- > 0;) {
                if (i % threads == thread) task(i);
            }
        });
    }
};

TEST(BuildOctree, MakesTheSameBytesOnAnyNumberOfThreads) {
    const TestMesh mesh = joined(random_soup(9, 30'000, 0.05), icosphere(4));
    const Octree alone = build_octree(mesh.positions, mesh.triangles,
                                      {.level = 7, .threshold = 10, .boxes_in = build::Frame{}});
    for (std::size_t threads = 2; threads <= 8; ++threads) {
        SomeThreads run{threads};
        const Octree octree = build_octree(
            mesh.positions, mesh.triangles,
            {.parallel_for = run, .level = 7, .threshold = 10, .boxes_in = build::Frame{}});
        EXPECT_EQ(std::memcmp(&octree.grid, &alone.grid, sizeof alone.grid), 0);
        EXPECT_TRUE(same_bytes(octree.nodes, alone.nodes));
        EXPECT_TRUE(same_bytes(octree.references, alone.references));
        EXPECT_TRUE(same_bytes(octree.leaf_codes, alone.leaf_codes));
        EXPECT_TRUE(same_bytes(octree.leaf_nodes, alone.leaf_nodes));
        EXPECT_TRUE(same_bytes(octree.top, alone.top));
        EXPECT_TRUE(same_bytes(octree.modulus_table, alone.modulus_table));
        EXPECT_TRUE(same_bytes(octree.mixed_table, alone.mixed_table));
        EXPECT_TRUE(same_bytes(octree.boxes, alone.boxes));
    }
}

// Ten triangles through all of the cube, in ever more cells: 4 times as many each level.
TEST(BuildOctree, GrowsNoLargerThanItSays) {
    TestMesh mesh;
    for (int i = 0; i < 10; ++i) {
        mesh = joined(mesh, {{{10, -10, 0.01 * i}, {-10, 0, 10}, {0, 10, -10}}, {{{0, 1, 2}}}});
    }
    const Octree octree =
        build_octree(mesh.positions, mesh.triangles, {.level = 21, .hashed = false});
    const std::uint64_t most = build::kMostFreeReferences + 10 * build::kMostReferencesPerTriangle;
    EXPECT_LE(octree.references.size(), most);
    EXPECT_GT(octree.references.size(), most / 8);
    expect_shape(octree);
    EXPECT_LT(level_of(octree.nodes.back().key), 21U);
}

// Beyond what is free of charge, each triangle has its share.
TEST(BuildOctree, ManyTrianglesHaveRoomForManyReferences) {
    const TestMesh mesh = random_soup(6, 100'000, 0.27);
    const Octree octree =
        build_octree(mesh.positions, mesh.triangles, {.level = 6, .hashed = false});
    const std::size_t share = build::kMostReferencesPerTriangle;
    EXPECT_GT(octree.references.size(), build::kMostFreeReferences + share + 100'000);
    EXPECT_LE(octree.references.size(), build::kMostFreeReferences + share * 100'000);
    EXPECT_EQ(level_of(octree.nodes.back().key), 6U);
}

// --- What finds cells ------------------------------------------------------------

std::vector<TestMesh> hashed_meshes() {
    return {TestMesh{}, unit_cube(), random_soup(2, 3000, 0.1), big_and_small(), fan(60)};
}

/// The node with a key by a chained table, or -1.
std::int64_t chained_node(const Octree& octree, const std::vector<std::uint32_t>& table,
                          std::uint64_t slot, std::uint64_t key) {
    const std::size_t slots = std::size_t{1} << octree.grid.slot_bits;
    std::size_t steps = 0;
    for (std::uint32_t i = table[slot]; i != 0; i = table[slots + i - 1]) {
        EXPECT_LE(++steps, octree.nodes.size());
        if (octree.nodes[i - 1].key == key) return std::int64_t{i} - 1;
    }
    return -1;
}

TEST(BuildOctree, TablesFindEveryNodeAndNothingElse) {
    for (const TestMesh& mesh : hashed_meshes()) {
        const Octree octree =
            build_octree(mesh.positions, mesh.triangles, {.level = 6, .threshold = 8});
        const std::uint32_t bits = octree.grid.slot_bits;
        ASSERT_EQ(octree.modulus_table.size(), (std::size_t{1} << bits) + octree.nodes.size());
        ASSERT_EQ(octree.mixed_table.size(), octree.modulus_table.size());
        const auto find = [&](std::uint64_t key) {
            const std::int64_t by_modulus =
                chained_node(octree, octree.modulus_table, key % (std::uint64_t{1} << bits), key);
            const std::int64_t mixed = chained_node(octree, octree.mixed_table,
                                                    key * format::kKeyMixer >> (64 - bits), key);
            EXPECT_EQ(by_modulus, mixed);
            return by_modulus;
        };
        for (std::size_t i = 0; i < octree.nodes.size(); ++i) {
            const OctreeNode& node = octree.nodes[i];
            ASSERT_EQ(find(node.key), static_cast<std::int64_t>(i));
            for (std::uint64_t child = 0; child < 8; ++child) {
                const bool there = is_inner(node) && (node.count >> child & 1) != 0;
                ASSERT_EQ(find(node.key << 3 | child) >= 0, there);
            }
        }
    }
}

TEST(BuildOctree, SortedLeavesAreTheLeavesAlongTheCurve) {
    for (const TestMesh& mesh : hashed_meshes()) {
        const Octree octree =
            build_octree(mesh.positions, mesh.triangles, {.level = 6, .threshold = 8});
        ASSERT_EQ(octree.leaf_codes.size(), octree.leaf_nodes.size());
        const auto leaves = static_cast<std::size_t>(
            std::count_if(octree.nodes.begin(), octree.nodes.end(),
                          [](const OctreeNode& node) { return !is_inner(node); }));
        ASSERT_EQ(octree.leaf_codes.size(), leaves);
        for (std::size_t i = 0; i < leaves; ++i) {
            const OctreeNode& node = octree.nodes[octree.leaf_nodes[i]];
            ASSERT_FALSE(is_inner(node));
            ASSERT_EQ(octree.leaf_codes[i], code_of(node.key));
            if (i == 0) continue;
            const OctreeNode& before = octree.nodes[octree.leaf_nodes[i - 1]];
            ASSERT_GE(octree.leaf_codes[i],
                      octree.leaf_codes[i - 1] + cells_below(level_of(before.key)));
        }
    }
}

TEST(BuildOctree, TheTopTableCountsTheLeavesBeforeEachCell) {
    for (const TestMesh& mesh : hashed_meshes()) {
        for (const std::uint32_t level : {0U, 1U, 6U, 12U}) {
            const Octree octree =
                build_octree(mesh.positions, mesh.triangles, {.level = level, .threshold = 8});
            const std::uint32_t top = octree.grid.top_level;
            ASSERT_LE(top, level);
            ASSERT_EQ(octree.top.size(), (std::size_t{1} << (3 * top)) + 1);
            for (std::size_t cell = 0; cell + 1 < octree.top.size(); ++cell) {
                const auto at = std::lower_bound(octree.leaf_codes.begin(), octree.leaf_codes.end(),
                                                 cell * cells_below(top));
                ASSERT_EQ(octree.top[cell], at - octree.leaf_codes.begin());
            }
            EXPECT_EQ(octree.top.back(), octree.leaf_codes.size());
        }
    }
}

TEST(BuildOctree, MakesNoTablesThatWereNotAskedFor) {
    const TestMesh mesh = icosphere(2);
    const Octree octree = build_octree(mesh.positions, mesh.triangles, {.hashed = false});
    EXPECT_TRUE(octree.leaf_codes.empty() && octree.leaf_nodes.empty() && octree.top.empty());
    EXPECT_TRUE(octree.modulus_table.empty() && octree.mixed_table.empty());
    EXPECT_FALSE(octree.nodes.empty());
}

}  // namespace
}  // namespace cdprep::test
