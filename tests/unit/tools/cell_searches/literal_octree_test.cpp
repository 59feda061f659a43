// SPDX-License-Identifier: MIT
#include "cell_searches/literal_octree.h"

#include <gtest/gtest.h>

#include "cdprep/advanced/query_counts.h"
#include "support/brute_force.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::study {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

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
