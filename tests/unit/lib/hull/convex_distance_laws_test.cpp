// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/exact_hull_pair.h"
#include "support/expect_distance.h"
#include "support/hull_pairs.h"
#include "support/rounds.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

/// How many pairs stand how.
struct Seen {
    int pairs = 0;
    int apart = 0;
    int touching = 0;
};

/// Asks in every form, and holds the answers against the truth: that of the definition,
/// or nothing where the hulls have a common point.
template <class Number>
void ask(const HullPair& pair, const std::optional<SquaredLength<Number>>& truth,
         std::mt19937& random) {
    const Edges edges = random() % 2 == 0 ? Edges::none : Edges::exact;
    const SmallHull hull_a(pair.a, edges), hull_b(pair.b, edges);
    const ConvexPoints a = hull_a.view(), b = hull_b.view();
    const Placement placement = Placement::b_moves(pair.pose);
    ConvexCache cache = nonsense(random);
    ASSERT_EQ(convex_collide(a, b, placement), !truth);
    ASSERT_EQ(convex_collide(a, b, placement, &cache), !truth);
    ASSERT_EQ(convex_collide(a, b, placement, &cache), !truth);
    ASSERT_EQ(convex_collide(b, a, Placement::a_moves(pair.pose)), !truth);
    if (random() % 2 == 0) cache = nonsense(random);
    const auto distance = convex_distance(a, b, placement, {}, &cache);
    ASSERT_TRUE(distance);
    if (!truth) {
        ASSERT_EQ(distance->upper, 0);
        return;
    }
    expect_distance(*distance, *truth);
    if (testing::Test::HasFatalFailure()) return;
    for (const double tolerance :
         {distance->lower, distance->upper, std::nearbyint(distance->upper)}) {
        ASSERT_EQ(convex_within(a, b, placement, tolerance, &cache),
                  compare_length(tolerance, *truth) >= 0);
        ASSERT_EQ(convex_within(b, a, Placement::a_moves(pair.pose), tolerance),
                  compare_length(tolerance, *truth) >= 0);
    }
}

template <class Number>
void count(const ExactHullPair<Number>& exact, bool apart, Seen& seen) {
    ++seen.pairs;
    if (apart) {
        ++seen.apart;
    } else if (sign_of(exact.squared_depth().numerator) == 0) {
        ++seen.touching;
    }
}

// By the definition, in integers.
TEST(ConvexDistanceLaws, GridHullsAreAnsweredAsByDefinition) {
    const int pairs = rounds(100'000, 5);
    std::mt19937 random(20240601);
    Seen seen;
    for (int i = 0; i < pairs; ++i) {
        SCOPED_TRACE(i);
        const HullPair pair = grid_pair(random);
        const ExactHullPair<Integer128> exact(pair.a, pair.placed);
        const auto truth = exact.squared_distance();
        count(exact, truth.has_value(), seen);
        ask(pair, truth, random);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(seen.apart, pairs * 3 / 10);
    EXPECT_LT(seen.apart, pairs * 7 / 10);
    EXPECT_GT(seen.touching, pairs / 10);
    EXPECT_GT(seen.pairs - seen.apart - seen.touching, pairs / 10);
}

/// Asks pairs that `next` draws, and holds them against the definition in exact numbers.
void ask_exactly(HullPair (*next)(std::mt19937&), int pairs, std::mt19937::result_type seed) {
    std::mt19937 random(seed);
    int apart = 0;
    for (int i = 0; i < pairs; ++i) {
        SCOPED_TRACE(i);
        const HullPair pair = next(random);
        const auto truth = ExactHullPair<ExactNumber>(pair.a, pair.placed).squared_distance();
        apart += truth ? 1 : 0;
        ask(pair, truth, random);
        if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(apart, pairs * 3 / 10);
    EXPECT_LT(apart, pairs * 7 / 10);
}

// Half of the pairs are within some 1e-16 of touching.
TEST(ConvexDistanceLaws, FineHullsAreAnsweredAsByDefinition) {
    ask_exactly(fine_pair, 1500, 20240602);
}

// Needles and plates.
TEST(ConvexDistanceLaws, ThinHullsAreAnsweredAsByDefinition) {
    ask_exactly(thin_pair, 1000, 20240606);
}

// By what must not matter: whether points lie in blocks or are named.
TEST(ConvexDistanceLaws, PointsByNumberAnswerAsThoseInBlocks) {
    std::mt19937 random(20240607);
    int apart = 0;
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE(i);
        const HullPair pair = i % 2 == 0 ? grid_pair(random) : fine_pair(random);
        const SmallHull a(pair.a, Edges::none), b(pair.b, Edges::none);
        std::vector<std::uint32_t> numbers(std::max(a.points().size(), b.points().size()));
        for (std::uint32_t n = 0; n < numbers.size(); ++n) numbers[n] = n;
        const auto named = [&](const SmallHull& hull) {
            ConvexPoints points;
            points.count = static_cast<std::uint32_t>(hull.points().size());
            points.corners = std::span(numbers).first(points.count);
            points.doubles = hull.points();
            return points;
        };
        const Placement placement = Placement::b_moves(pair.pose);
        const auto one = convex_distance(a.view(), b.view(), placement);
        const auto other = convex_distance(named(a), named(b), placement);
        ASSERT_TRUE(one && other);
        ASSERT_EQ(one->lower, other->lower);
        ASSERT_EQ(one->upper, other->upper);
        ASSERT_EQ(one->witness_a.x, other->witness_a.x);
        apart += one->lower > 0 ? 1 : 0;
    }
    EXPECT_GT(apart, 600);
    EXPECT_LT(apart, 1400);
}

// By what must not matter: whether every point is looked at or edges are climbed, which
// hull is asked first, and where a cache begins, in walks that pass through each other.
TEST(ConvexDistanceLaws, ClimbingAndLookingAtAllPointsAgree) {
    std::mt19937 random(20240605);
    int questions = 0, apart = 0;
    for (int walk = 0; walk < 300; ++walk) {
        SCOPED_TRACE(walk);
        const bool coarse = walk % 2 == 0;
        const double size = coarse ? 8 : 1;
        const Points at_a = ball_points(random, 150, coarse),
                     at_b = ball_points(random, 80, coarse);
        const SmallHull hull_a(at_a), hull_b(at_b);
        const ConvexPoints a = hull_a.view(), b = hull_b.view();
        ConvexPoints plain_a = a, plain_b = b;
        plain_a.neighbour_begins = plain_b.neighbour_begins = {};
        const auto turn = coarse ? quarter_turns(random) : random_pose(random, 1).rotation();
        ConvexCache cache, other;
        for (int step = 0; step < 20; ++step) {
            const Pose pose = pose_of(turn, {(2.4 - 0.05 * step) * size, 0.5 * size, 0});
            const Placement placement = Placement::b_moves(pose);
            const auto climbed = convex_distance(a, b, placement, {}, &cache);
            const auto scanned = convex_distance(plain_b, plain_a, Placement::a_moves(pose));
            ++questions;
            apart += climbed->lower > 0 ? 1 : 0;
            ASSERT_EQ(climbed->lower > 0, scanned->lower > 0);
            ASSERT_LE(climbed->lower, scanned->upper);
            ASSERT_LE(scanned->lower, climbed->upper);
            ASSERT_EQ(convex_collide(a, b, placement, &other), climbed->upper == 0);
            ASSERT_EQ(convex_collide(plain_a, plain_b, placement), climbed->upper == 0);
            ASSERT_LE(climbed->upper - climbed->lower, 1e-12 * climbed->upper + 1e-13 * size);
        }
    }
    EXPECT_GT(apart, questions * 3 / 10);
    EXPECT_LT(apart, questions * 7 / 10);
}

}  // namespace
}  // namespace cdprep::test
