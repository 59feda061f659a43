// SPDX-License-Identifier: MIT
#include "cdprep/convex_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/exact_hull_pair.h"
#include "support/hull_pairs.h"
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
    constexpr double kReach = 14;  // of A - B at most
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
    ASSERT_GT(distance->lower, 0);
    ASSERT_LE(compare_length(distance->lower, *truth), 0);
    ASSERT_GE(compare_length(distance->upper, *truth), 0);
    ASSERT_LE(distance->upper - distance->lower, 1e-12 * distance->upper + 1e-14 * kReach);
    const Double3 &p = distance->witness_a, &q = distance->witness_b;
    ASSERT_NEAR(std::hypot(p.x - q.x, p.y - q.y, p.z - q.z), distance->upper, 1e-14 * kReach);
    for (const double tolerance :
         {distance->lower, distance->upper, std::nearbyint(distance->upper)}) {
        ASSERT_EQ(convex_is_within(a, b, placement, tolerance, &cache),
                  compare_length(tolerance, *truth) >= 0);
        ASSERT_EQ(convex_is_within(b, a, Placement::a_moves(pair.pose), tolerance),
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
    constexpr int kPairs = 100000;
    std::mt19937 random(20240601);
    Seen seen;
    for (int i = 0; i < kPairs; ++i) {
        SCOPED_TRACE(i);
        const HullPair pair = grid_pair(random);
        const ExactHullPair<Integer128> exact(pair.a, pair.placed);
        const auto truth = exact.squared_distance();
        count(exact, truth.has_value(), seen);
        ask(pair, truth, random);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(seen.apart, kPairs * 3 / 10);
    EXPECT_LT(seen.apart, kPairs * 7 / 10);
    EXPECT_GT(seen.touching, kPairs / 10);
    EXPECT_GT(seen.pairs - seen.apart - seen.touching, kPairs / 10);
}

// By the definition, in exact numbers; half of the pairs are within some 1e-16 of touching.
TEST(ConvexDistanceLaws, FineHullsAreAnsweredAsByDefinition) {
    constexpr int kPairs = 1500;
    std::mt19937 random(20240602);
    int apart = 0;
    for (int i = 0; i < kPairs; ++i) {
        SCOPED_TRACE(i);
        const HullPair pair = fine_pair(random);
        const auto truth = ExactHullPair<ExactNumber>(pair.a, pair.placed).squared_distance();
        apart += truth ? 1 : 0;
        ask(pair, truth, random);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(apart, kPairs * 3 / 10);
    EXPECT_LT(apart, kPairs * 7 / 10);
}

}  // namespace
}  // namespace cdprep::test
