// SPDX-License-Identifier: MIT
#include "cdprep/cells/build_tetra_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "cdprep/cells/build_octree.h"
#include "cdprep/format/octree.h"
#include "support/aligned_bytes.h"
#include "support/exact_cone.h"
#include "support/meshes.h"
#include "support/rounds.h"

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
    if (!mesh.positions.empty()) options.frame_origin = mesh.positions[0];
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

// Nothing is lost but the rounding to float where edges cross planes at no grazing angle.
TEST(BuildTetraTree, RadiiAreTight) {
    int asked = 0;
    const TestMesh mesh = in_floats(moved_by(icosphere(2), 1.1, {0.01, 0.02, 0.03}));
    const TetraTree tree = tree_of(mesh, {.level = 2});
    const double frame = std::ldexp(1.0, -std::ilogb(longest_side(mesh)) - 2) / std::sqrt(3.0);
    for (const TetraNode& node : tree.nodes) {
        if (!is_leaf(node)) continue;
        ++asked;
        const std::uint32_t octant = node.key >> (2 * tetra_level(node.key));
        double least = INFINITY;
        double greatest = 0;
        for (const std::uint32_t triangle : list_of(tree, node)) {
            for (const ExactPoint& p :
                 cut_by_cone(corners_of(mesh, triangle), tree.tree.centre, tetra_cone(node.key))) {
                double sum = 0;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const auto x = static_cast<double>(p[axis].approximation());
                    sum += (octant >> axis & 1U) != 0 ? -x : x;
                }
                least = std::min(least, sum * frame);
                greatest = std::max(greatest, sum * frame);
            }
        }
        EXPECT_NEAR(node.radius_min, least, 0x1p-20 * least);
        EXPECT_NEAR(node.radius_max, greatest, 0x1p-20 * greatest);
    }
    EXPECT_EQ(asked, 8 * 16);
}

TEST(BuildTetraTree, RadiusMinIsZeroOfThePapersTetrahedra) {
    const TestMesh mesh = icosphere(2);
    const TetraTree caps = tree_of(mesh, {});
    TetraTree tetra = tree_of(mesh, {.bounding = format::TetraBounding::tetra});
    ASSERT_EQ(tetra.nodes.size(), caps.nodes.size());
    for (std::size_t i = 0; i < caps.nodes.size(); ++i) {
        EXPECT_EQ(tetra.nodes[i].radius_min, 0);
        EXPECT_EQ(tetra.nodes[i].radius_max, caps.nodes[i].radius_max);
        EXPECT_GT(caps.nodes[i].radius_min, 0);
    }
}

/// Leaves at or below a node.
void gather_leaves(const TetraTree& tree, const TetraNode& node, std::vector<TetraNode>& leaves) {
    if (is_leaf(node)) return leaves.push_back(node);
    for (std::uint32_t k = 0; k < node.count; ++k) {
        gather_leaves(tree, tree.nodes[node.first + k], leaves);
    }
}

/// The corners of what the triangles below a node have in its cone, in the frame, exactly.
std::vector<ExactPoint> parts_in_frame(const TestMesh& mesh, const TetraTree& tree,
                                       const TetraNode& node) {
    const double longest = longest_side(mesh);
    const std::int32_t exponent = longest > 0 ? -std::ilogb(longest) - 2 : 0;
    const ExactRational unit(std::ldexp(1.0, exponent / 2));
    const ExactRational rest(std::ldexp(1.0, exponent - exponent / 2));
    const Double3& c = tree.tree.centre;
    const Double3& o = mesh.positions[0];
    const std::array<ExactRational, 3> shift = {ExactRational(c.x) - ExactRational(o.x),
                                                ExactRational(c.y) - ExactRational(o.y),
                                                ExactRational(c.z) - ExactRational(o.z)};
    std::vector<TetraNode> leaves;
    gather_leaves(tree, node, leaves);
    std::vector<ExactPoint> parts;
    for (const TetraNode& leaf : leaves) {
        for (const std::uint32_t triangle : list_of(tree, leaf)) {
            for (ExactPoint p : cut_by_cone(corners_of(mesh, triangle), c, tetra_cone(node.key))) {
                for (std::size_t k = 0; k < 3; ++k) p[k] = (p[k] + shift[k]) * unit * rest;
                parts.push_back(p);
            }
        }
    }
    return parts;
}

void expect_in_box(const ExactPoint& p, const format::BvhNode& boxes, std::size_t lane) {
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(ExactRational(double{boxes.lower[k][lane]}), p[k]);
        EXPECT_GE(ExactRational(double{boxes.upper[k][lane]}), p[k]);
    }
}

/// A number of the frame, but for 2^-52. Of long fractions approximation() is not a number.
double rounded_frame(const ExactRational& x) {
    const auto near = static_cast<double>(x.approximation());
    if (std::isfinite(near)) return near;
    double lower = -2;
    for (double step = 2; step > 0x1p-53; step /= 2) {
        if (ExactRational(lower + step) <= x) lower += step;
    }
    return lower;
}

/// With the third axis as exact numbers and as floats have it. Sums of a few products of
/// numbers below 4 are off by less than 2^-48, and are short of the half extents by more.
void expect_in_oriented(const ExactPoint& p, const format::OrientedNode& boxes, std::size_t lane) {
    std::array<std::array<float, 3>, 2> axis{};
    std::array<double, 3> from{};
    for (std::size_t i = 0; i < 3; ++i) {
        axis[0][i] = boxes.axis[0][i][lane];
        axis[1][i] = boxes.axis[1][i][lane];
        from[i] = rounded_frame(p[i]) - double{boxes.centre[i][lane]};
    }
    const auto expect_within = [&](const std::array<double, 3>& direction, std::size_t k) {
        const double along =
            direction[0] * from[0] + direction[1] * from[1] + direction[2] * from[2];
        EXPECT_LT(std::fabs(along) + 0x1p-48, double{boxes.half[k][lane]});
    };
    std::array<double, 3> third{};
    std::array<double, 3> rounded{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t m = (i + 2) % 3;
        third[i] =
            double{axis[0][j]} * double{axis[1][m]} - double{axis[0][m]} * double{axis[1][j]};
        rounded[i] = double{axis[0][j] * axis[1][m] - axis[0][m] * axis[1][j]};
    }
    for (std::size_t k = 0; k < 2; ++k) {
        expect_within({double{axis[k][0]}, double{axis[k][1]}, double{axis[k][2]}}, k);
    }
    expect_within(third, 2);
    expect_within(rounded, 2);
}

/// Whether what stands twice is the same.
template <class Boxes>
bool agree(const std::vector<Boxes>& all, std::size_t node) {
    using Rows = std::array<std::array<float, 8>, sizeof(Boxes) / 32>;
    const auto here = std::bit_cast<Rows>(all[node / 4]);
    const auto there = std::bit_cast<Rows>(all[node / 4 - 1]);
    for (std::size_t row = 0; row < here.size(); ++row) {
        if (here[row][node % 4] != there[row][node % 4 + 4]) return false;
    }
    return true;
}

// Of every node, wherever its boxes stand.
TEST(BuildTetraTree, BoxesHoldTheClippedTrianglesInExactArithmetic) {
    for (const TestMesh& mesh : awkward_meshes()) {
        const TetraTree tree =
            tree_of(mesh, {.level = 3, .threshold = 3, .bounding = format::TetraBounding::boxes});
        ASSERT_EQ(tree.boxes.size(), format::tetra_box_count(tree.nodes.size()));
        ASSERT_EQ(tree.oriented.size(), tree.boxes.size());
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            for (const ExactPoint& p : parts_in_frame(mesh, tree, tree.nodes[i])) {
                expect_in_box(p, tree.boxes[i / 4], i % 4);
                expect_in_oriented(p, tree.oriented[i / 4], i % 4);
            }
            if (i < 4) continue;
            EXPECT_TRUE(agree(tree.boxes, i));
            EXPECT_TRUE(agree(tree.oriented, i));
        }
    }
}

// As radii are. Oriented ones are thin where the surface is.
TEST(BuildTetraTree, BoxesAreTight) {
    const TestMesh mesh = in_floats(moved_by(icosphere(3), 1.1, {0.01, 0.02, 0.03}));
    const TetraTree tree = tree_of(mesh, {.level = 3, .bounding = format::TetraBounding::boxes});
    std::size_t thin = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const std::vector<ExactPoint> parts = parts_in_frame(mesh, tree, tree.nodes[i]);
        const format::BvhNode& boxes = tree.boxes[i / 4];
        for (std::size_t k = 0; k < 3; ++k) {
            double lower = INFINITY;
            double upper = -INFINITY;
            for (const ExactPoint& p : parts) {
                lower = std::min(lower, static_cast<double>(p[k].approximation()));
                upper = std::max(upper, static_cast<double>(p[k].approximation()));
            }
            EXPECT_NEAR(boxes.lower[k][i % 4], lower, 0x1p-22);
            EXPECT_NEAR(boxes.upper[k][i % 4], upper, 0x1p-22);
        }
        const auto& half = tree.oriented[i / 4].half;
        if (is_leaf(tree.nodes[i]) && half[0][i % 4] < half[2][i % 4] / 8) ++thin;
    }
    EXPECT_GT(thin, tree.nodes.size() / 2);
}

// A box is never larger than those of the children together.
TEST(BuildTetraTree, AnInnerNodesBoxIsThatAroundItsChildren) {
    for_trees([](const TestMesh& mesh, const TetraTree& other) {
        const TetraTree tree = tree_of(mesh, {.level = other.tree.level,
                                              .threshold = other.tree.threshold,
                                              .bounding = format::TetraBounding::boxes});
        ASSERT_TRUE(tree.references == other.references);
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            const TetraNode& node = tree.nodes[i];
            if (is_leaf(node)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                float lower = 1;
                float upper = -1;
                for (std::size_t child = node.first; child < node.first + node.count; ++child) {
                    lower = std::min(lower, tree.boxes[child / 4].lower[k][child % 4]);
                    upper = std::max(upper, tree.boxes[child / 4].upper[k][child % 4]);
                }
                EXPECT_EQ(tree.boxes[i / 4].lower[k][i % 4], lower);
                EXPECT_EQ(tree.boxes[i / 4].upper[k][i % 4], upper);
            }
        }
    });
}

// By hand.
TEST(BuildTetraTree, TheCentreIsTheMeanOfTheVerticesThatTrianglesUse) {
    TestMesh mesh = {{{0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1}, {1e300, NAN, -7}, {3, 3, 0.1}},
                     {{{0, 1, 2}}, {{0, 1, 4}}, {{1, 0, 2}}}};
    const TetraTree tree = build_tetra_tree(mesh.positions, mesh.triangles);
    EXPECT_EQ(tree.tree.centre, (Double3{1, 1, 0.1}));  // a flat mesh stays in its plane
    mesh.positions[4] = {3, 3.1, 0.1};
    EXPECT_NEAR(build_tetra_tree(mesh.positions, mesh.triangles).tree.centre.y, 1.025, 1e-15);
    mesh = in_floats(moved_by(icosphere(2), 1, {0.123, 0, 0}));
    const double x = build_tetra_tree(mesh.positions, mesh.triangles).tree.centre.x;
    EXPECT_EQ(x, double{static_cast<float>(x)});
    EXPECT_NEAR(x, 0.123, 1e-7);
}

TEST(BuildTetraTree, SaysWhetherTheCentreIsInside) {
    const auto flags = [](const TestMesh& mesh) {
        return build_tetra_tree(mesh.positions, mesh.triangles, {.level = 2}).tree.flags;
    };
    const TestMesh sphere = moved_by(icosphere(2), 1, {1e6, 0.3, -2});
    EXPECT_EQ(flags(sphere), format::tetra_centre_inside);
    EXPECT_EQ(flags(reversed(sphere)), format::tetra_centre_inside);
    EXPECT_EQ(flags(moved_by(icosphere(2), 0x1p-1000, {})), format::tetra_centre_inside);
    EXPECT_EQ(flags(torus(1, 0.3, 20, 9)), 0U);
    // Hollow.
    EXPECT_EQ(flags(joined(icosphere(2), reversed(moved_by(icosphere(2), 0.5, {})))), 0U);
    EXPECT_EQ(flags(plate()), format::tetra_centre_on);
}

/// A parallel_for of so many threads, which take tasks from the last.
class Threads {
public:
    explicit Threads(std::size_t count) : count_(count) {}
    void operator()(std::size_t tasks, Task task) const {
        std::atomic<std::size_t> left = tasks;
        const auto work = [&] {
            for (std::size_t i = left--; i - 1 < tasks; i = left--) task(i - 1);
        };
        std::vector<std::thread> threads;
        for (std::size_t i = 0; i < count_; ++i) threads.emplace_back(work);
        for (std::thread& thread : threads) thread.join();
    }

private:
    std::size_t count_;
};

bool same_trees(const TetraTree& a, const TetraTree& b) {
    return std::memcmp(&a.tree, &b.tree, sizeof a.tree) == 0 && same_bytes(a.nodes, b.nodes) &&
           same_bytes(a.references, b.references) && same_bytes(a.top, b.top) &&
           same_bytes(a.boxes, b.boxes) && same_bytes(a.oriented, b.oriented);
}

TEST(BuildTetraTree, IsTheSameOnAnyNumberOfThreads) {
    for (const TestMesh& mesh : {icosphere(5), moved_by(grid_sheet(60, 60), 1, {-30, -30, 0}),
                                 random_soup(1, 9000, 0.3), fan(2000)}) {
        for (const TetraTreeOptions& setting :
             {TetraTreeOptions{}, TetraTreeOptions{.level = 4, .threshold = 100},
              TetraTreeOptions{
                  .level = 4, .threshold = 20, .bounding = format::TetraBounding::boxes}}) {
            const TetraTree alone = tree_of(mesh, setting);
            for (const std::size_t count : {2U, 5U, 1U, 3U, 4U, 8U}) {
                if (!asks_all() && count != 2 && count != 5) continue;
                const Threads threads(count);
                TetraTreeOptions options = setting;
                options.parallel_for = threads;
                EXPECT_TRUE(same_trees(tree_of(mesh, options), alone)) << count;
            }
        }
    }
}

/// Axes permuted, then reversed: 48 of them.
Double3 turned(const Double3& p, std::size_t number) {
    std::array<double, 3> x = {p.x, p.y, p.z};
    for (std::size_t i = 0; i < number / 16; ++i) x = {x[1], x[2], x[0]};
    if (number / 8 % 2 != 0) std::swap(x[0], x[1]);
    for (std::size_t i = 0; i < 3; ++i) {
        if ((number >> i & 1U) != 0) x[i] = -x[i];
    }
    return {x[0], x[1], x[2]};
}

// Whole coordinates, and as many on the other side: their mean is 0, exactly.
TEST(BuildTetraTree, TurningAMeshAboutItsCentreChangesNothingButLabels) {
    std::mt19937 random(9);
    std::uniform_int_distribution<int> whole(-40, 40);
    TestMesh mesh;
    for (std::uint32_t i = 0; i < 80; ++i) {
        for (int k = 0; k < 3; ++k) {
            const Double3 p = {double(whole(random)), double(whole(random)), double(whole(random))};
            mesh.positions.push_back(p);
            mesh.positions.push_back({-p.x, -p.y, -p.z});
        }
        mesh.triangles.push_back({{6 * i, 6 * i + 2, 6 * i + 5}});
        mesh.triangles.push_back({{6 * i + 1, 6 * i + 4, 6 * i + 3}});
    }
    const TetraTreeOptions options = {.level = 3, .threshold = 12};
    const TetraTree tree = tree_of(mesh, options);
    ASSERT_EQ(tree.tree.centre, (Double3{0, 0, 0}));
    for (std::size_t number = 0; number < 48; ++number) {
        TestMesh other = mesh;
        for (Double3& p : other.positions) p = turned(p, number);
        const TetraTree of_other = tree_of(other, options);
        ASSERT_EQ(of_other.nodes.size(), tree.nodes.size());
        EXPECT_EQ(of_other.references.size(), tree.references.size());
        for (const TetraNode& node : tree.nodes) {
            Double3 middle{};
            for (const Generator& g : tetra_cone(node.key).generator) {
                middle = {middle.x + g[0], middle.y + g[1], middle.z + g[2]};
            }
            const std::uint32_t key =
                tetra_key({0, 0, 0}, turned(middle, number), tetra_level(node.key));
            const auto same = std::find_if(of_other.nodes.begin(), of_other.nodes.end(),
                                           [&](const TetraNode& n) { return n.key == key; });
            ASSERT_TRUE(same != of_other.nodes.end());
            ASSERT_EQ(same->flags == 0, is_leaf(node));
            EXPECT_EQ(same->count, node.count);
            if (is_leaf(node)) {
                EXPECT_EQ(list_of(of_other, *same), list_of(tree, node));
            }
            EXPECT_NEAR(same->radius_min, node.radius_min, 0x1p-20F);
            EXPECT_NEAR(same->radius_max, node.radius_max, 0x1p-20F);
        }
    }
}

// Of each cone of the top level: the node, or the leaf above it.
TEST(BuildTetraTree, TheTopTableNamesWhereToGoOn) {
    for_trees([](const TestMesh&, const TetraTree& tree) {
        const std::uint32_t first = format::tetra_cones(tree.tree.top_level);
        ASSERT_EQ(tree.top.size(), first);
        for (std::uint32_t i = 0; i < first; ++i) {
            std::uint32_t expected = 0;
            for (std::uint32_t key = first + i; key >= 8 && expected == 0; key >>= 2) {
                for (std::uint32_t k = 0; k < tree.nodes.size(); ++k) {
                    const TetraNode& node = tree.nodes[k];
                    const bool ends = key == first + i || is_leaf(node);
                    if (node.key == key && ends) expected = k + 1;
                }
            }
            EXPECT_EQ(tree.top[i], expected);
        }
    });
}

/// Keys of leaves and what they list: of a tree with a threshold, from the lists of one that
/// was split everywhere.
std::map<std::uint32_t, std::set<std::uint32_t>> expected_leaves(const TetraTree& finest,
                                                                 std::uint32_t threshold) {
    std::map<std::uint32_t, std::set<std::uint32_t>> lists;
    for (const TetraNode& node : finest.nodes) {
        if (!is_leaf(node)) continue;
        const std::set<std::uint32_t> list = list_of(finest, node);
        for (std::uint32_t key = node.key; key >= 8; key >>= 2) {
            lists[key].insert(list.begin(), list.end());
        }
    }
    for (auto it = lists.begin(); it != lists.end();) {
        const auto parent = lists.find(it->first >> 2);
        const bool has_split_parent =
            it->first < 16 || (parent != lists.end() && parent->second.size() >= threshold);
        it = has_split_parent ? std::next(it) : lists.erase(it);
    }
    std::erase_if(lists, [&](const auto& entry) {
        return tetra_level(entry.first) < finest.tree.level && entry.second.size() >= threshold;
    });
    return lists;
}

// However lists come about: those of several levels at once, or level by level.
TEST(BuildTetraTree, AThresholdMergesWhatIsNotSplit) {
    for (const TestMesh& mesh : {moved_by(icosphere(4), 1, {0.1, 0, 0}), torus(1, 0.4, 90, 40),
                                 random_soup(8, 9000, 0.2)}) {
        const TetraTree finest = tree_of(mesh, {.level = 4});
        for (const std::uint32_t threshold : {2U, 3U, 30U, 200U, 100000U}) {
            const TetraTree tree = tree_of(mesh, {.level = 4, .threshold = threshold});
            std::map<std::uint32_t, std::set<std::uint32_t>> leaves;
            for (const TetraNode& node : tree.nodes) {
                if (is_leaf(node)) leaves[node.key] = list_of(tree, node);
            }
            EXPECT_EQ(leaves, expected_leaves(finest, threshold)) << threshold;
        }
    }
}

// Level 14 of an octahedron would have 2^31 leaves.
TEST(BuildTetraTree, DoesNotOutgrowItsLimit) {
    const TestMesh mesh = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                           {{{0, 1, 2}},
                            {{1, 3, 2}},
                            {{3, 4, 2}},
                            {{4, 0, 2}},
                            {{1, 0, 5}},
                            {{3, 1, 5}},
                            {{4, 3, 5}},
                            {{0, 4, 5}}}};
    const TetraTree tree = tree_of(mesh, {.level = 14});
    EXPECT_LE(tree.references.size(), build::kMostFreeReferences + 8 * 64);
    EXPECT_GT(tree.references.size(), build::kMostFreeReferences / 8);
    EXPECT_EQ(tree.tree.level, 14U);
    const std::uint32_t deepest = tetra_level(tree.nodes.back().key);
    for (const TetraNode& node : tree.nodes) {
        ASSERT_EQ(is_leaf(node), tetra_level(node.key) == deepest);
    }
}

// Beyond what is free of charge, each triangle has its share.
TEST(BuildTetraTree, ManyTrianglesHaveRoomForManyReferences) {
    const TestMesh mesh = random_soup(6, 100'000, 0.2);
    const TetraTree tree = tree_of(mesh, {.level = 6});
    const std::size_t share = build::kMostReferencesPerTriangle;
    EXPECT_GT(tree.references.size(), build::kMostFreeReferences + share + 100'000);
    EXPECT_LE(tree.references.size(), build::kMostFreeReferences + share * 100'000);
    EXPECT_EQ(tetra_level(tree.nodes.back().key), 6U);
}

}  // namespace
}  // namespace cdprep::test
