// SPDX-License-Identifier: MIT
#include "compare/cells/literal_octree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cdprep/advanced/query_counts.h"
#include "core/moved_model.h"
#include "support/brute_force.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::study {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

/// The same file with the model's own box as its oriented one, turned about z by 45 degrees
/// where it is to be wider than it need be.
OpenModel with_bounds(const TestMesh& mesh, bool turned) {
    format::Bounds bounds{};
    Box3 box = box_of({mesh.positions[0], mesh.positions[0], mesh.positions[0]});
    for (const Double3& p : mesh.positions) {
        box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y),
                     std::min(box.lower.z, p.z)};
        box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y),
                     std::max(box.upper.z, p.z)};
    }
    const double s = turned ? std::sqrt(0.5) : 0, c = turned ? std::sqrt(0.5) : 1;
    bounds.lower = box.lower;
    bounds.upper = box.upper;
    bounds.oriented_centre = {(box.lower.x + box.upper.x) / 2, (box.lower.y + box.upper.y) / 2,
                              (box.lower.z + box.upper.z) / 2};
    bounds.axis = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    const double x = (box.upper.x - box.lower.x) / 2, y = (box.upper.y - box.lower.y) / 2;
    bounds.half_extent = {(c * x + s * y) * 1.0001, (s * x + c * y) * 1.0001,
                          (box.upper.z - box.lower.z) / 2 * 1.0001};
    return open_tiny(with_sections(
        bake_tiny(mesh.positions, mesh.triangles),
        {as_section(SectionId::bounds, std::span<const format::Bounds>(&bounds, 1))}));
}

/// Triangles of B that the set keeps, source numbers; and those in leaves that it keeps are no
/// fewer.
std::vector<bool> kept(const Model& a, const Model& b, const Placement& placement) {
    const PotentialSet set(a, b, placement);
    std::vector<bool> result(b.triangle_count());
    const MovedModel stored(b, nullptr);
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < b.triangle_count(); ++i) {
        const bool holds = set.holds(stored.corners(i));
        result[b.source().triangle[i]] = holds;
        count += holds ? 1 : 0;
    }
    EXPECT_LE(count, set.triangles_in_leaves());
    EXPECT_LE(set.triangles_in_leaves(), b.triangle_count());
    return result;
}

// A law: what overlaps is potentially colliding; and most of what is not is left out.
TEST(PotentialSet, HoldsEveryTriangleThatOverlaps) {
    std::mt19937 random(41);
    const TestMesh a = icosphere(3), b = torus(1.5, 0.3, 40, 16);
    const OpenModel plain = open_tiny(a);
    const OpenModel straight = with_bounds(a, false), turned = with_bounds(a, true);
    const OpenModel model_b = open_tiny(b), bounded_b = with_bounds(b, true);
    Workspace workspace;
    std::size_t held = 0, overlapping = 0, asked = 0;
    for (int round = 0; round < 40; ++round) {
        const Pose p = random_pose(random, 1.5), q = random_pose(random, 1);
        for (const Placement& placement :
             {Placement::b_moves(p), Placement::a_moves(p), Placement::world(p, q)}) {
            const auto pairs = all_pairs(plain.model, model_b.model, placement, workspace);
            for (const OpenModel* box : {&plain, &straight, &turned}) {
                for (const OpenModel* of_b : {&model_b, &bounded_b}) {
                    const auto in_set = kept(box->model, of_b->model, placement);
                    for (const TrianglePair& pair : pairs) ASSERT_TRUE(in_set[pair.b]) << round;
                    held +=
                        static_cast<std::size_t>(std::count(in_set.begin(), in_set.end(), true));
                    asked += in_set.size();
                    overlapping += pairs.size();
                }
            }
        }
    }
    EXPECT_GT(overlapping, 10'000U);
    EXPECT_GT(held, asked * 3 / 10);
    EXPECT_LT(held, asked * 7 / 10);
}

// By construction: boxes a hair apart clip everything, boxes that touch keep the touch.
TEST(PotentialSet, TouchingIsKeptAndApartIsNot) {
    const TestMesh cube = unit_cube();
    const OpenModel model = with_bounds(cube, false);
    Workspace workspace;
    const auto count = [&](double x) {
        const Placement placement =
            Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, {x, 0, 0}).value());
        const auto in_set = kept(model.model, model.model, placement);
        return std::count(in_set.begin(), in_set.end(), true);
    };
    EXPECT_GE(count(1), 6);  // a face and all that share its edges
    EXPECT_LT(count(1), 12);
    EXPECT_EQ(count(1.01), 0);
    EXPECT_EQ(count(0), 12);
}

OpenModel open_with_octree(const TestMesh& mesh, const build::OctreeOptions& options) {
    return open_tiny(with_octree(bake_tiny(mesh.positions, mesh.triangles), options));
}

std::vector<TrianglePair> literal_pairs(const Model& a, const Model& b, const Placement& placement,
                                        const LiteralOptions& options = {}) {
    std::vector<TrianglePair> pairs;
    const auto keep = [&](const TrianglePair& pair) {
        pairs.push_back(pair);
        return true;
    };
    EXPECT_TRUE(visit_literal_overlaps(a, b, placement, options, keep));
    std::ranges::sort(pairs);
    return pairs;
}

// B12, the talk's mistake: a triangle with corners ten radii away goes through the sphere, and no
// corner is in any cell.
TEST(LiteralOctree, MissesABigTriangleThroughASmallModel) {
    const TestMesh big = {{{10, 0.1, 0}, {-7, 9, 0.3}, {-7, -9, 0.2}}, {{{0, 1, 2}}}};
    const OpenModel a = open_with_octree(icosphere(3), {.level = 5, .threshold = 4});
    const OpenModel b = open_with_octree(big, {.level = 5, .threshold = 4});
    Workspace workspace;
    const Placement as_they_are = Placement::b_moves(Pose());
    EXPECT_GT(all_pairs(a.model, b.model, as_they_are, workspace).size(), 30U);
    EXPECT_TRUE(literal_pairs(a.model, b.model, as_they_are).empty());
}

// A law: what it finds is among the pairs, each once, the same by every way to find a cell, and it
// is not all of them.
TEST(LiteralOctree, FindsAPartOfThePairs) {
    std::mt19937 random(31);
    Workspace workspace;
    std::size_t all = 0, found = 0;
    for (int round = 0; round < 30; ++round) {
        const TestMesh a = round % 2 == 0 ? icosphere(3) : random_soup(random(), 300, 0.2);
        const TestMesh b = round % 2 == 0 ? icosphere(2) : random_soup(random(), 200, 0.2);
        const OpenModel model_a = open_with_octree(a, {.level = 4, .threshold = 4});
        const OpenModel model_b = open_with_octree(b, {.level = 4, .threshold = 4});
        const Pose p = random_pose(random, 0.8), q = random_pose(random, 0.3);
        for (const Placement& placement :
             {Placement::b_moves(p), Placement::a_moves(p), Placement::world(p, q)}) {
            const auto expected = all_pairs(model_a.model, model_b.model, placement, workspace);
            const auto some = literal_pairs(model_a.model, model_b.model, placement);
            ASSERT_TRUE(std::ranges::includes(expected, some));
            ASSERT_EQ(std::ranges::adjacent_find(some), some.end());
            for (const CellSearch search : {CellSearch::sorted, CellSearch::mixed}) {
                ASSERT_EQ(
                    literal_pairs(model_a.model, model_b.model, placement, {.search = search}),
                    some);
            }
            all += expected.size();
            found += some.size();
        }
    }
    EXPECT_GT(found, all * 3 / 10);
    EXPECT_LT(found, all * 98 / 100);
}

// By hand: two triangles that cross, each in the one cell of its octree; three corners are sought.
TEST(LiteralOctree, CountsItsWorkAndEndsWhenTold) {
    const TestMesh lying = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{{0, 1, 2}}}};
    const TestMesh standing = {{{1, 1, -1}, {1, 1, 1}, {2, 1, 1}}, {{{0, 1, 2}}}};
    const OpenModel a = open_with_octree(standing, {.level = 0});
    const OpenModel b = open_with_octree(lying, {.level = 0});
    const Placement shifted =
        Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, {0.5, 0.5, 0}).value());
    QueryCounts counts;
    const auto pairs = literal_pairs(a.model, b.model, shifted, {.counts = &counts});
    EXPECT_EQ(counts.potential, 1U);
    EXPECT_EQ(counts.cells_sought, 3U);
    const auto end = [](const TrianglePair&) { return false; };
    EXPECT_EQ(visit_literal_overlaps(a.model, b.model, shifted, {}, end), pairs.empty());
}

}  // namespace
}  // namespace cdprep::study
