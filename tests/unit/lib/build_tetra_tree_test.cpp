// SPDX-License-Identifier: MIT
#include "cdprep/build_tetra_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <thread>

#include "cdprep/format/octree.h"
#include "support/exact_cone.h"
#include "support/meshes.h"
#include "support/run_threads.h"

namespace cdprep::test {
namespace {

using build::build_tetra_tree;
using build::TetraTree;
using build::TetraTreeOptions;
using format::kSharedReference;
using format::TetraNode;

bool is_leaf(const TetraNode& node) {
    return (node.flags & format::tetra_inner) == 0;
}

Corners corners_of(const TestMesh& mesh, std::uint32_t triangle) {
    const auto& v = mesh.triangles[triangle].vertex;
    return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

double longest_side(const TestMesh& mesh) {
    double longest = 0;
    for (double Double3::*x : {&Double3::x, &Double3::y, &Double3::z}) {
        double lower = INFINITY;
        double upper = -INFINITY;
        for (const Double3& p : mesh.positions) {
            lower = std::min(lower, p.*x);
            upper = std::max(upper, p.*x);
        }
        longest = std::max(longest, upper - lower);
    }
    return longest;
}

/// With radii in a unit that suits the mesh, as bakes have it.
TetraTree tree_of(const TestMesh& mesh, TetraTreeOptions options) {
    const double longest = longest_side(mesh);
    options.frame_exponent = longest > 0 ? -std::ilogb(longest) - 2 : 0;
    return build_tetra_tree(mesh.positions, mesh.triangles, options);
}

/// A flat plate through its own middle, whose cones are cut in arcs.
TestMesh plate() {
    return moved_by(grid_sheet(5, 5), 1, {-2.5, -2.5, 0});
}

std::vector<TestMesh> awkward_meshes() {
    TestMesh point = copies_of_one_triangle(5);
    for (Double3& p : point.positions) p = {3, -2, 0.5};
    TestMesh line = grid_sheet(6, 1);
    for (Double3& p : line.positions) p.y = p.x;
    return {TestMesh{},
            point,
            line,
            fan(1),
            fan(30),
            plate(),
            unit_cube(),
            icosphere(1),
            torus(1, 0.3, 10, 6),
            in_floats(moved_by(icosphere(1), 1.1, {0.01, 0.02, 0.03})),
            random_soup(1, 60, 0.3),
            random_soup(2, 20, 2),
            coarse_grid_soup(2, 60, 2),
            copies_of_one_triangle(12),
            geometric_progression(40),
            moved_by(random_soup(3, 20, 0.5), 0x1p-1000, {}),
            moved_by(fan(20), 0x1p-1060, {}),
            moved_by(random_soup(4, 20, 0.5), 0x1p998, {}),
            moved_by(unit_cube(), 0x1p1000, {-0x1p999, 0, 0}),
            moved_by(torus(1, 0.2, 12, 6), 1e-3, {1e6, -1e6, 1e6})};
}

std::vector<TetraTreeOptions> settings() {
    return {{.level = 0}, {.level = 2}, {.level = 4, .threshold = 10}};
}

/// Calls body(mesh, tree) for every mesh and setting.
template <class Body>
void for_trees(const Body& body) {
    for (const TestMesh& mesh : awkward_meshes()) {
        for (const TetraTreeOptions& options : settings()) {
            body(mesh, tree_of(mesh, options));
        }
    }
}

std::set<std::uint32_t> list_of(const TetraTree& tree, const TetraNode& leaf) {
    std::set<std::uint32_t> list;
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        list.insert(tree.references[i] & ~kSharedReference);
    }
    return list;
}

bool holds_centre(const TestMesh& mesh, const TetraTree& tree, std::uint32_t triangle) {
    const Double3& c = tree.tree.centre;
    // Held by two cones that have the apex alone in common.
    return !cut_by_cone(corners_of(mesh, triangle), c, tetra_cone(8)).empty() &&
           triangles_touch_by_segments(corners_of(mesh, triangle), {c, c, c});
}

/// What the subtree of a cone must be, asked of every triangle by cutting.
void expect_lists(const TestMesh& mesh, const TetraTree& tree, std::uint32_t key,
                  const std::vector<std::uint32_t>& candidates,
                  std::vector<std::uint32_t>& leaves) {
    std::vector<std::uint32_t> touching;
    for (const std::uint32_t triangle : candidates) {
        if (!cut_by_cone(corners_of(mesh, triangle), tree.tree.centre, tetra_cone(key)).empty()) {
            touching.push_back(triangle);
        }
    }
    const auto node = std::find_if(tree.nodes.begin(), tree.nodes.end(),
                                   [&](const TetraNode& n) { return n.key == key; });
    if (touching.empty()) {
        EXPECT_TRUE(node == tree.nodes.end()) << key;
        return;
    }
    ASSERT_TRUE(node != tree.nodes.end()) << key;
    const bool split = tetra_level(key) < tree.tree.level && touching.size() >= tree.tree.threshold;
    ASSERT_EQ(is_leaf(*node), !split);
    if (split) {
        for (std::uint32_t child = 0; child < 4; ++child) {
            expect_lists(mesh, tree, key << 2 | child, touching, leaves);
        }
        return;
    }
    leaves.push_back(key);
    const std::set<std::uint32_t> list = list_of(tree, *node);
    EXPECT_EQ(list, std::set<std::uint32_t>(touching.begin(), touching.end())) << key;
    EXPECT_EQ(list.size(), node->count);
}

TEST(BuildTetraTree, ListsAreThoseOfBruteForce) {
    for_trees([](const TestMesh& mesh, const TetraTree& tree) {
        std::set<std::uint32_t> centre;
        std::vector<std::uint32_t> others;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            if (holds_centre(mesh, tree, i)) {
                centre.insert(i);
            } else {
                others.push_back(i);
            }
        }
        const auto first = tree.references.begin();
        EXPECT_EQ(std::set<std::uint32_t>(first, first + tree.tree.centre_count), centre);
        EXPECT_EQ((tree.tree.flags & format::tetra_centre_on) != 0, !centre.empty());
        std::vector<std::uint32_t> leaves;
        for (std::uint32_t key = 8; key < 16; ++key) expect_lists(mesh, tree, key, others, leaves);
        const auto count = std::count_if(tree.nodes.begin(), tree.nodes.end(), is_leaf);
        EXPECT_EQ(static_cast<std::size_t>(count), leaves.size());
    });
}

// Every triangle is somewhere, and the bit of those that are in several leaves is set.
TEST(BuildTetraTree, ReferencesSayWhetherTheyAreShared) {
    for_trees([](const TestMesh& mesh, const TetraTree& tree) {
        std::vector<int> uses(mesh.triangles.size());
        for (const std::uint32_t item : tree.references) ++uses[item & ~kSharedReference];
        for (const std::uint32_t item : tree.references) {
            EXPECT_EQ((item & kSharedReference) != 0, uses[item & ~kSharedReference] > 1);
        }
        EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0);
    });
}

TEST(BuildTetraTree, NodesAndListsFollowEachOther) {
    for_trees([](const TestMesh&, const TetraTree& tree) {
        std::uint32_t reference = tree.tree.centre_count;
        std::uint32_t child = 0;
        while (child < tree.nodes.size() && tree.nodes[child].key < 16) ++child;
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            const TetraNode& node = tree.nodes[i];
            if (i > 0) {
                EXPECT_LT(tree.nodes[i - 1].key, node.key);
            }
            EXPECT_EQ(node.first, is_leaf(node) ? reference : child);
            EXPECT_GT(node.count, 0U);
            if (is_leaf(node)) {
                const auto list = tree.references.begin() + reference;
                EXPECT_TRUE(std::is_sorted(list, list + node.count, [](auto a, auto b) {
                    return (a & ~kSharedReference) < (b & ~kSharedReference);
                }));
                reference += node.count;
                EXPECT_EQ(node.flags, 0U);
                continue;
            }
            std::uint32_t mask = format::tetra_inner;
            for (std::uint32_t k = 0; k < node.count; ++k, ++child) {
                EXPECT_EQ(tree.nodes[child].key >> 2, node.key);
                mask |= 1U << (tree.nodes[child].key & 3U);
            }
            EXPECT_EQ(node.flags, mask);
        }
        EXPECT_EQ(reference, tree.references.size());
        EXPECT_EQ(child, tree.nodes.size());
    });
}

// A radius is the sum of coordinates by the root of 3: squares are compared.
void expect_radii(const TestMesh& mesh, const TetraTree& tree, const TetraNode& node,
                  std::int32_t exponent) {
    const std::uint32_t octant = node.key >> (2 * tetra_level(node.key));
    const auto bound = [&](float radius) {
        const ExactRational r(double{radius});
        return r * r * ExactRational(3.0);
    };
    const ExactRational unit(std::ldexp(1.0, exponent / 2));
    const ExactRational rest(std::ldexp(1.0, exponent - exponent / 2));
    const ExactRational lower = bound(node.radius_min);
    const ExactRational upper = bound(node.radius_max);
    EXPECT_GE(node.radius_min, 0);
    EXPECT_TRUE(std::isfinite(node.radius_max));
    for (const std::uint32_t triangle : list_of(tree, node)) {
        for (const ExactPoint& p :
             cut_by_cone(corners_of(mesh, triangle), tree.tree.centre, tetra_cone(node.key))) {
            ExactRational sum;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                sum = (octant >> axis & 1U) != 0 ? sum - p[axis] : sum + p[axis];
            }
            sum = sum * unit * rest;
            EXPECT_LE(lower, sum * sum);
            EXPECT_GE(upper, sum * sum);
            EXPECT_GE(sum.sign(), 0);
        }
    }
}

TEST(BuildTetraTree, RadiiHoldTheClippedTrianglesInExactArithmetic) {
    for (const TestMesh& mesh : awkward_meshes()) {
        const double longest = longest_side(mesh);
        const std::int32_t exponent = longest > 0 ? -std::ilogb(longest) - 2 : 0;
        for (const std::uint32_t level : {0U, 3U}) {
            const TetraTree tree = tree_of(mesh, {.level = level, .threshold = 3});
            for (const TetraNode& node : tree.nodes) {
                if (is_leaf(node)) expect_radii(mesh, tree, node, exponent);
            }
        }
    }
}

}  // namespace
}  // namespace cdprep::test
