// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "cdprep/advanced/query_counts.h"
#include "cdprep/self.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

std::vector<TrianglePair> ask_itself(const TestMesh& mesh, const SelfOptions& options = {}) {
    const OpenModel model = open_tiny(mesh, {.double_precision = true});
    Workspace workspace;
    return all_own_pairs(model.model, workspace, options);
}

/// Two triangles that cross, or touch with the tip of the second, `lowest` above the first.
TestMesh spear(double lowest) {
    return {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, lowest}, {2, 1, 3}, {1, 2, 3}},
            {{{0, 1, 2}}, {{3, 4, 5}}}};
}

TEST(SelfOverlaps, OfAnEmptyModelAreNone) {
    EXPECT_TRUE(ask_itself({}).empty());
}

// One leaf against itself: the pair comes once, the smaller number first.
TEST(SelfOverlaps, OfTwoTrianglesThatCrossIsOnePair) {
    const std::vector<TrianglePair> one = {{0, 1}};
    EXPECT_EQ(ask_itself(spear(-1)), one);
    EXPECT_EQ(ask_itself(spear(-1), {.overlap = Overlap::proper}), one);
    EXPECT_TRUE(ask_itself(spear(0x1p-40)).empty());
    EXPECT_TRUE(ask_itself(right_triangle()).empty());
}

TEST(SelfOverlaps, TouchingIsClosedButNotProper) {
    EXPECT_EQ(ask_itself(spear(0)).size(), 1U);
    EXPECT_TRUE(ask_itself(spear(0), {.overlap = Overlap::proper}).empty());
}

// By the definition: at one place with two numbers they touch, with one number they do not.
TEST(SelfOverlaps, AVertexIsSharedByItsNumber) {
    const TestMesh apart{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 1}, {0, -1, 1}},
                         {{{0, 1, 2}}, {{3, 4, 5}}}};
    EXPECT_EQ(ask_itself(apart).size(), 1U);
    EXPECT_TRUE(ask_itself(apart, {.overlap = Overlap::proper}).empty());
    EXPECT_TRUE(ask_itself(with_shared_vertices(apart)).empty());
    // Two that fold onto each other about a common edge overlap, and are no pair.
    const TestMesh folded{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.5, 0}},
                          {{{0, 1, 2}}, {{1, 0, 3}}}};
    EXPECT_TRUE(ask_itself(folded).empty());
}

TEST(SelfOverlaps, OfSurfacesThatDoNotMeetThemselvesAreNone) {
    for (const TestMesh& mesh : {icosphere(4), torus(1, 0.25, 48, 24), grid_sheet(40, 30),
                                 turned(grid_sheet(40, 30), 0.3), three_sheets(), fan(100)}) {
        EXPECT_TRUE(ask_itself(mesh).empty()) << mesh.triangles.size();
    }
}

// Copies with vertices of their own: every two overlap. Each pair once, in all leaf pairs.
TEST(SelfOverlaps, OfCopiesAreAllPairs) {
    for (const int count : {2, 7, 8, 9, 16, 17, 100, 600}) {
        const auto all = static_cast<std::size_t>(count) * static_cast<std::size_t>(count - 1) / 2;
        for (const Overlap overlap : {Overlap::closed, Overlap::proper}) {
            const auto pairs = ask_itself(copies_of_one_triangle(count), {.overlap = overlap});
            EXPECT_EQ(pairs.size(), all) << count;
            EXPECT_TRUE(std::ranges::is_sorted(pairs));
            EXPECT_EQ(std::ranges::adjacent_find(pairs), pairs.end());
            EXPECT_TRUE(
                std::ranges::all_of(pairs, [](const TrianglePair& p) { return p.a < p.b; }));
        }
    }
}

TEST(SelfOverlaps, DegenerateTrianglesCountUnlessTheyAreSkipped) {
    TestMesh mesh = spear(-1);
    mesh.positions.insert(mesh.positions.end(), {{1, 1, -2}, {1, 1, 0}, {1, 1, 5}});
    mesh.triangles.push_back({{6, 7, 8}});  // a segment through the first two
    mesh.positions.push_back({0.5, 0.5, 0});
    mesh.triangles.push_back({{9, 9, 9}});  // a point on the first
    EXPECT_EQ(ask_itself(mesh), (std::vector<TrianglePair>{{0, 1}, {0, 2}, {0, 3}, {1, 2}}));
    EXPECT_EQ(ask_itself(mesh, {.overlap = Overlap::proper}), (std::vector<TrianglePair>{{0, 1}}));
    EXPECT_EQ(ask_itself(mesh, {.degenerate = Degenerate::skip}),
              (std::vector<TrianglePair>{{0, 1}}));
}

// If the room is too short, it holds the smallest pairs, and the count is that of all.
TEST(SelfOverlaps, AShortRoomHoldsTheSmallestPairs) {
    const OpenModel model = open_tiny(random_soup(5, 400, 1.2), {.double_precision = true});
    Workspace workspace;
    const auto all = all_own_pairs(model.model, workspace);
    ASSERT_GT(all.size(), 200U);
    for (const std::size_t room :
         {std::size_t{0}, std::size_t{1}, all.size() / 3, all.size() - 1, all.size() + 5}) {
        std::vector<TrianglePair> pairs(room, {7777, 7777});
        EXPECT_EQ(self_overlaps(model.model, workspace, pairs), all.size());
        const std::size_t kept = std::min(room, all.size());
        EXPECT_TRUE(std::equal(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(kept),
                               all.begin()));
        for (std::size_t i = kept; i < room; ++i) EXPECT_EQ(pairs[i].a, 7777U);
    }
}

TEST(SelfOverlaps, AVisitorSeesEachPairOnceOrEndsTheSearch) {
    const OpenModel model = open_tiny(random_soup(6, 400, 1.2), {.double_precision = true});
    Workspace workspace;
    const auto all = all_own_pairs(model.model, workspace);
    std::vector<TrianglePair> visited;
    const auto visit = [&](const TrianglePair& pair) {
        visited.push_back(pair);
        return true;
    };
    EXPECT_TRUE(visit_self_overlaps(model.model, workspace, visit));
    std::ranges::sort(visited);
    EXPECT_EQ(visited, all);
    for (const std::size_t most : {std::size_t{1}, std::size_t{5}, all.size()}) {
        std::size_t seen = 0;
        const auto stop = [&](const TrianglePair&) { return ++seen < most; };
        EXPECT_FALSE(visit_self_overlaps(model.model, workspace, stop));
        EXPECT_EQ(seen, most);
    }
    std::size_t skipped = 0;
    const auto count = [&](const TrianglePair&) { return ++skipped > 0; };
    EXPECT_TRUE(
        visit_self_overlaps(model.model, workspace, count, {.degenerate = Degenerate::skip}));
    EXPECT_EQ(skipped, all.size());
}

// By hand: a node of two boxes makes three pairs, and its leaves three.
TEST(SelfOverlaps, AreCounted) {
    const OpenModel model = open_tiny(copies_of_one_triangle(10));
    Workspace workspace;
    QueryCounts counts;
    workspace.count_into(&counts);
    EXPECT_EQ(self_overlaps(model.model, workspace, {}), 45U);
    EXPECT_EQ(counts.node_pairs, 1U);
    EXPECT_EQ(counts.box_pairs, 3U);
    EXPECT_EQ(counts.leaf_pairs, 3U);
    EXPECT_EQ(counts.by_kernel + counts.by_corner + counts.by_filter + counts.by_exact, 45U);
}

}  // namespace
}  // namespace cdprep::test
