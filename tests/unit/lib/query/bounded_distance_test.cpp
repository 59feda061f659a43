// SPDX-License-Identifier: MIT
#include "cdprep/bounded_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "cdprep/advanced/query_counts.h"
#include "support/brute_force_distance.h"
#include "support/open_tiny.h"
#include "support/placements.h"
#include "support/random_pose.h"
#include "support/rounds.h"
#include "support/same_distance.h"

namespace cdprep::test {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// The most that the last pair of leaves may exceed the work by.
constexpr std::uint64_t kMostExcess = 64 * (kWorkOfTriangles + kWorkOfExact) + kWorkOfLeaves;

/// Two soups, some of which touch, and how they are placed.
struct BoundedCase {
    TestMesh a;
    TestMesh b;
    Placement placement = Placement::b_moves(Pose());
};

BoundedCase bounded_case(std::mt19937& random, int round, int triangles) {
    const bool coarse = round % 2 == 0;
    const auto soup = [&] {
        return coarse ? coarse_grid_soup(random(), triangles, 2)
                      : random_soup(random(), triangles, 0.2);
    };
    BoundedCase made{soup(), soup()};
    const double reach = std::pow(10, static_cast<int>(random() % 3) - 1);
    const Pose turned = Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, 5 * reach, 0.5, 1}).value();
    const Pose p = coarse ? turned : random_pose(random, 2 * reach);
    const Pose q = random_pose(random, reach);
    made.placement = placement_of_kind(random(), p, q);
    return made;
}

TEST(BoundedDistance, WithoutALimitItIsTheDistance) {
    std::mt19937 random(20261126);
    const int kRounds = rounds(4000, 4);
    int touching = 0;
    for (int round = 0; round < kRounds; ++round) {
        const BoundedCase c = bounded_case(random, round, 60);
        const OpenModel a = open_tiny(c.a, {.double_precision = round % 3 == 0});
        const OpenModel b = open_tiny(c.b);
        Workspace workspace;
        const Pair pair{a.model, b.model, c.placement};
        DistanceOptions options;
        if (round % 5 == 0) options.max_distance = 0.5;
        const auto expected = distance(pair, workspace, options);
        PairCache cache;
        Pair cached = pair;
        cached.cache = &cache;
        for (int again = 0; again < 3; ++again) {
            const BoundedDistance found =
                bounded_distance(again == 0 ? pair : cached, workspace, options);
            ASSERT_TRUE(found.is_complete);
            expect_same(found.nearest, expected);
            EXPECT_EQ(found.lower, expected ? expected->lower : options.max_distance);
            EXPECT_EQ(found.upper, expected ? expected->upper : kNoLimit);
            EXPECT_GT(found.work, 0U);
        }
        touching += expected && expected->upper == 0 ? 1 : 0;
    }
    EXPECT_GT(touching, kRounds / 10);
    EXPECT_LT(touching, kRounds * 9 / 10);
}

// The oracle: every pair of triangles in rational arithmetic.
TEST(BoundedDistance, TheBoundsOfEveryBudgetHoldTheTruth) {
    std::mt19937 random(20261127);
    const int kRounds = rounds(400, 4);
    std::size_t late = 0, with_both = 0, complete = 0;
    for (int round = 0; round < kRounds; ++round) {
        const BoundedCase c = bounded_case(random, round, 24);
        const OpenModel a = open_tiny(c.a, {.double_precision = round % 3 == 0});
        const OpenModel b = open_tiny(c.b);
        Workspace workspace;
        const Pair pair{a.model, b.model, c.placement};
        const ExactRational truth = brute_force_distance(c.a, c.b, c.placement);
        const std::uint64_t all = bounded_distance(pair, workspace).work;
        for (std::uint64_t work = 1; work <= all + 1; ++work) {
            const BoundedDistance found = bounded_distance(pair, workspace, {}, {.work = work});
            ASSERT_TRUE(square(found.lower) <= truth) << round << ", " << work;
            if (found.upper < kNoLimit) {
                ASSERT_TRUE(truth <= square(found.upper)) << round << ", " << work;
            }
            ASSERT_LE(found.work, work + kMostExcess);
            ASSERT_EQ(found.nearest.has_value(), found.upper < kNoLimit);
            if (found.is_complete) {
                ++complete;
                expect_same(found.nearest, distance(pair, workspace));
                continue;
            }
            ++late;
            with_both += found.lower > 0 && found.upper < kNoLimit ? 1 : 0;
            if (found.nearest) {
                EXPECT_EQ(found.nearest->lower, found.lower);
                EXPECT_EQ(found.nearest->upper, found.upper);
            }
        }
        EXPECT_TRUE(bounded_distance(pair, workspace, {}, {.work = all + 1}).is_complete);
    }
    const auto least = static_cast<std::size_t>(kRounds);
    EXPECT_GT(late, 10 * least);
    EXPECT_GT(with_both, least);
    EXPECT_GT(complete, least / 2);
}

// A ball circles above a torus. With a cache, even the least work gives close bounds.
TEST(BoundedDistance, ACacheKeepsLateBoundsClose) {
    const OpenModel a = open_tiny(torus(1, 0.3, 40, 30));
    const OpenModel b = open_tiny(moved_by(icosphere(2), 0.1, {}));
    Workspace workspace;
    PairCache cache, of_truth;
    LastDistance last;
    std::size_t late = 0, close = 0;
    for (int step = 0; step < 3000; ++step) {
        const double angle = 0.002 * step, height = 0.5 + 0.05 * std::sin(0.01 * step);
        const Placement placement =
            shifted({std::cos(angle), std::sin(angle), height + (step % 7 == 0 ? 1e-4 : 0)});
        const Pair pair{a.model, b.model, placement, {}, &cache};
        // A whole answer now and then, such as from a slow loop.
        const std::uint64_t work = step % 25 == 0 ? 0 : 1 + step % 12;
        const BoundedDistance found =
            bounded_distance(pair, workspace, {}, {.work = work, .last = &last});
        const auto truth = distance({a.model, b.model, placement, {}, &of_truth}, workspace);
        ASSERT_LE(found.lower, truth->upper);
        ASSERT_GE(found.upper, truth->lower);
        ASSERT_TRUE(last.is_known);
        if (found.is_complete) {
            EXPECT_EQ(last.late, 0U);
            EXPECT_EQ(last.placement.pose_b().translation(), placement.pose_b().translation());
            EXPECT_EQ(last.distance.upper, found.upper);
            expect_same(found.nearest, truth);
            continue;
        }
        ++late;
        EXPECT_GT(last.late, 0U);
        close += found.upper - found.lower < 0.1 * truth->upper ? 1 : 0;
    }
    EXPECT_GT(late, 1500U);
    EXPECT_GT(close, late / 2);
}

TEST(BoundedDistance, NothingIsFoundWithoutTrianglesOrBeyondTheLimit) {
    const OpenModel cube = open_tiny(unit_cube());
    const OpenModel empty = open_tiny(std::span<const Double3>(), std::span<const Triangle>());
    Workspace workspace;
    const BoundedDistance none =
        bounded_distance({cube.model, empty.model, shifted({})}, workspace, {.max_distance = 4});
    EXPECT_TRUE(none.is_complete);
    EXPECT_FALSE(none.nearest);
    EXPECT_EQ(none.lower, 4);
    EXPECT_EQ(none.upper, kNoLimit);
    const Pair far{cube.model, cube.model, shifted({3, 0, 0})};
    const BoundedDistance beyond = bounded_distance(far, workspace, {.max_distance = 1});
    EXPECT_TRUE(beyond.is_complete);
    EXPECT_FALSE(beyond.nearest);
    EXPECT_EQ(beyond.lower, 1);
    EXPECT_NEAR(bounded_distance(far, workspace, {.max_distance = 2}).upper, 2, 1e-12);
    for (const double bad : {-1.0, std::nan("")}) {
        const BoundedDistance found = bounded_distance(far, workspace, {.max_distance = bad});
        EXPECT_TRUE(found.is_complete);
        EXPECT_FALSE(found.nearest);
        EXPECT_EQ(found.lower, 0);
    }
}

// Counting goes on as if the query had not counted for itself.
TEST(BoundedDistance, ItsWorkIsCountedWithThatOfOthers) {
    const OpenModel a = open_tiny(icosphere(3)), b = open_tiny(icosphere(2));
    Workspace workspace;
    QueryCounts counts;
    workspace.count_into(&counts);
    const Pair pair{a.model, b.model, shifted({2.5, 0, 0})};
    EXPECT_FALSE(bounded_distance(pair, workspace, {}, {.work = 3}).is_complete);
    EXPECT_GE(counts.node_pairs, 3U);
    const std::uint64_t before = counts.node_pairs;
    EXPECT_TRUE(distance(pair, workspace));
    EXPECT_GT(counts.node_pairs, before);
}

}  // namespace
}  // namespace cdprep::test
