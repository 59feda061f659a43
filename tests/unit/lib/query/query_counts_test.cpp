// SPDX-License-Identifier: MIT
#include "cdprep/advanced/query_counts.h"

#include <gtest/gtest.h>

#include "cdprep/pairs.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/placements.h"

namespace cdprep::test {
namespace {

std::uint64_t decided(const QueryCounts& counts) {
    return counts.by_kernel + counts.by_corner + counts.by_filter + counts.by_exact;
}

// By hand: one triangle each is one leaf each, one pair of triangles, and one box that
// stands for each of them.
TEST(QueryCounts, SayWhatOnePairOfTrianglesTakes) {
    const TestMesh lying{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 1, 2}}}};
    const TestMesh standing{{{0.25, 0.25, -1}, {0.5, 0.25, -1}, {0.25, 0.25, 1}}, {{{0, 1, 2}}}};
    const OpenModel a = open_tiny(lying), b = open_tiny(standing);
    Workspace workspace;
    QueryCounts counts;
    workspace.count_into(&counts);
    EXPECT_EQ(overlaps({a.model, b.model, shifted({0, 0, 0})}, workspace, {}), 1u);
    EXPECT_EQ(counts.box_pairs, 1u);
    EXPECT_EQ(counts.node_pairs, 1u);
    EXPECT_EQ(counts.leaf_pairs, 1u);
    EXPECT_EQ(counts.triangle_pairs, 1u);
    EXPECT_EQ(counts.by_kernel, 1u);
    EXPECT_EQ(decided(counts), 1u);

    workspace.count_into(nullptr);
    EXPECT_EQ(overlaps({a.model, b.model, shifted({0, 0, 0})}, workspace, {}), 1u);
    EXPECT_EQ(counts.box_pairs, 1u);
}

// By construction: on itself every pair that touches shares a corner; aside in its
// plane, by steps that are no whole squares, none does and exact signs are 0.
TEST(QueryCounts, SayWhichStageDecided) {
    const OpenModel sheet = open_tiny(grid_sheet(8, 8));
    Workspace workspace;
    QueryCounts itself;
    workspace.count_into(&itself);
    const std::size_t pairs =
        overlaps({sheet.model, sheet.model, shifted({0, 0, 0})}, workspace, {});
    EXPECT_EQ(itself.by_corner, pairs);
    EXPECT_EQ(itself.by_kernel, 0u);

    QueryCounts aside;
    workspace.count_into(&aside);
    const std::size_t covered =
        overlaps({sheet.model, sheet.model, shifted({0.3125, 0.1875, 0})}, workspace, {});
    EXPECT_EQ(aside.by_corner, 0u);
    EXPECT_GE(aside.by_exact, covered);
    EXPECT_GT(covered, 500u);
    EXPECT_LE(decided(aside), aside.triangle_pairs);
}

TEST(QueryCounts, AreTakenForEveryQuestionAboutTwoModels) {
    const OpenModel ball = open_tiny(icosphere(3));
    Workspace workspace;
    const auto taken = [&](auto ask) {
        QueryCounts counts;
        workspace.count_into(&counts);
        ask();
        workspace.count_into(nullptr);
        return counts;
    };
    const Placement near = shifted({2.01, 0, 0}), crossing = shifted({1, 0, 0});
    const QueryCounts hit = taken([&] {
        EXPECT_TRUE(collide({ball.model, ball.model, crossing}, workspace).hit == Answer::yes);
    });
    const QueryCounts all = taken(
        [&] { EXPECT_GT(all_pairs(ball.model, ball.model, crossing, workspace).size(), 50u); });
    EXPECT_GT(hit.leaf_pairs, 0u);
    EXPECT_LT(hit.box_pairs, all.box_pairs);  // the first hit ends it
    // Nodes hold up to eight boxes, and of most pairs of nodes several boxes are tested.
    EXPECT_LT(all.node_pairs, all.box_pairs);
    EXPECT_GE(64 * all.node_pairs, all.box_pairs);
    const QueryCounts apart = taken([&] {
        EXPECT_TRUE(distance({ball.model, ball.model, near}, workspace));
    });
    EXPECT_GT(apart.measured, 0u);
    EXPECT_LE(apart.measured, apart.triangle_pairs);
    // A gap so narrow that double tells it too widely.
    const OpenModel cube = open_tiny(unit_cube());
    const QueryCounts narrow = taken([&] {
        EXPECT_TRUE(
            distance({cube.model, cube.model, shifted({1 + 1e-9, 0.25, 0.125})}, workspace));
    });
    EXPECT_GT(narrow.measured_again, 0u);
    const QueryCounts near_enough = taken([&] {
        EXPECT_FALSE(within({ball.model, ball.model, near}, 0.005, workspace));
    });
    EXPECT_GT(near_enough.box_pairs, 0u);
    EXPECT_LT(near_enough.box_pairs, apart.box_pairs);
}

}  // namespace
}  // namespace cdprep::test
