// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "cdprep/parallel.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/run_threads.h"

// The truth in all of these is overlaps() on one thread.

namespace cdprep::test {
namespace {

constexpr auto one_after_the_other = [](std::size_t count, Task task) {
    for (std::size_t i = count; i > 0; --i) task(i - 1);
};

/// Room of `size`, filled by a split question; returns the number of pairs.
std::size_t split(const Model& a, const Model& b, const Placement& placement, std::size_t workers,
                  ParallelFor run, std::vector<TrianglePair>& room, std::size_t size,
                  const PairOptions& options = {}) {
    std::vector<Workspace> workspaces(workers);
    room.assign(size, {7, 7});
    return split_overlaps({a, b, placement, options}, workspaces, run, room);
}

// A sphere that touches itself everywhere, and some of it turned: enough pairs for
// several rounds of everything, and for parts that are sorted apart.
TEST(SplitOverlap, OneToEightThreadsGiveTheSerialPairs) {
    const OpenModel a = open_tiny(icosphere(4));
    std::mt19937 random(1);
    Workspace workspace;
    for (const Pose& pose : {Pose(), random_pose(random, 0.01), random_pose(random, 0.5),
                             random_pose(random, 1), random_pose(random, 10)}) {
        const Placement placement = Placement::b_moves(pose);
        const auto expected = all_pairs(a.model, a.model, placement, workspace);
        for (std::size_t workers = 1; workers <= 8; ++workers) {
            std::vector<TrianglePair> pairs;
            const std::size_t count = split(a.model, a.model, placement, workers, run_threads,
                                            pairs, expected.size() + 3);
            ASSERT_EQ(count, expected.size()) << workers;
            ASSERT_TRUE(std::equal(expected.begin(), expected.end(), pairs.begin())) << workers;
        }
    }
    EXPECT_GT(all_pairs(a.model, a.model, Placement::b_moves(Pose()), workspace).size(), 50'000u);
}

TEST(SplitOverlap, ShortRoomTakesTheSmallestPairsAndAllAreCounted) {
    const OpenModel a = open_tiny(icosphere(3)), b = open_tiny(torus(1, 0.25, 40, 20));
    const Placement placement = Placement::b_moves(Pose());
    Workspace workspace;
    const auto expected = all_pairs(a.model, b.model, placement, workspace);
    ASSERT_GT(expected.size(), 300u);
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, std::size_t{100}, expected.size() - 1, expected.size()}) {
        for (const std::size_t workers : {1, 3, 8}) {
            std::vector<TrianglePair> pairs;
            EXPECT_EQ(split(a.model, b.model, placement, workers, run_threads, pairs, size),
                      expected.size());
            EXPECT_TRUE(std::equal(pairs.begin(), pairs.end(), expected.begin())) << size;
        }
    }
}

// Soups on a coarse grid: touching and degenerate triangles are common.
TEST(SplitOverlap, EveryOptionAndPlacementIsKept) {
    std::mt19937 random(3);
    std::size_t hits = 0, asked = 0;
    for (int round = 0; round < 40; ++round) {
        const OpenModel a = open_tiny(coarse_grid_soup(random(), 60 + round, 3));
        const OpenModel b = open_tiny(coarse_grid_soup(random(), 40, 3));
        Workspace workspace;
        const Pose p = round % 2 == 0 ? Pose() : random_pose(random, 6);
        const Pose q = random_pose(random, 6);
        for (const Placement& placement :
             {Placement::b_moves(p), Placement::a_moves(p), Placement::world(p, q)}) {
            for (const PairOptions& options :
                 {PairOptions{},
                  PairOptions{.overlap = Overlap::proper, .degenerate = Degenerate::skip}}) {
                const auto expected = all_pairs(a.model, b.model, placement, workspace, options);
                std::vector<TrianglePair> pairs;
                const std::size_t count = split(a.model, b.model, placement, 4, run_threads, pairs,
                                                expected.size(), options);
                ASSERT_EQ(count, expected.size()) << round;
                ASSERT_EQ(pairs, expected) << round;
                hits += expected.empty() ? 0 : 1;
                ++asked;
            }
        }
    }
    EXPECT_GT(hits, asked * 3 / 10);
    EXPECT_LT(hits, asked * 9 / 10);
}

// A task that starts when the others have done all the work finds none.
TEST(SplitOverlap, AnyOrderOfTasksWillDo) {
    const OpenModel a = open_tiny(icosphere(3));
    const Placement placement = Placement::b_moves(Pose());
    Workspace workspace;
    const auto expected = all_pairs(a.model, a.model, placement, workspace);
    std::vector<TrianglePair> pairs;
    EXPECT_EQ(split(a.model, a.model, placement, 5, one_after_the_other, pairs, expected.size()),
              expected.size());
    EXPECT_EQ(pairs, expected);
}

TEST(SplitOverlap, EmptyModelsOverlapNothing) {
    const OpenModel empty = open_tiny(TestMesh{}), cube = open_tiny(unit_cube());
    std::vector<TrianglePair> pairs;
    const Placement still = Placement::b_moves(Pose());
    EXPECT_EQ(split(empty.model, cube.model, still, 3, run_threads, pairs, 5), 0u);
    EXPECT_EQ(split(cube.model, empty.model, still, 3, run_threads, pairs, 5), 0u);
}

}  // namespace
}  // namespace cdprep::test
