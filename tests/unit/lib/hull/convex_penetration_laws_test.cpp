// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_penetration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/exact_hull_pair.h"
#include "support/hull_pairs.h"
#include "support/small_hull.h"

#include "exact/vectors.h"

namespace cdprep::test {
namespace {

/// How far a point lies outside the hull of some points: the most by a plane through any three
/// of them, or across an axis. Of a hull in a plane, points beside that count too.
double outside(const Double3& p, const std::vector<Double3>& points) {
    double most = 0;
    const auto try_normal = [&](const Double3& n) {
        const double length = std::hypot(n.x, n.y, n.z);
        if (!(length > 1e-9)) return;
        double highest = -std::numeric_limits<double>::infinity();
        for (const Double3& q : points) highest = std::max(highest, cdprep::dot(n, q));
        most = std::max(most, (cdprep::dot(n, p) - highest) / length);
    };
    for (const double side : {1.0, -1.0}) {
        for (const Double3& axis : {Double3{1, 0, 0}, Double3{0, 1, 0}, Double3{0, 0, 1}}) {
            try_normal(side * axis);
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                for (std::size_t k = 0; k < j; ++k) {
                    try_normal(side * cdprep::cross(points[i] - points[k], points[j] - points[k]));
                }
            }
        }
    }
    return most;
}

/// Holds the depth against the truth. Counts those that meet.
template <class Number>
void ask(const HullPair& pair, std::mt19937& random, int& met) {
    constexpr double kReach = 14;  // of A - B at most
    const ExactHullPair<Number> exact(pair.a, pair.placed);
    const bool apart = exact.squared_distance().has_value();
    const Edges edges = random() % 2 == 0 ? Edges::none : Edges::exact;
    const SmallHull hull_a(pair.a, edges), hull_b(pair.b, edges);
    const ConvexPoints a = hull_a.view(), b = hull_b.view();
    ConvexCache cache = nonsense(random);
    const auto found = convex_penetration(a, b, Placement::b_moves(pair.pose), {}, &cache);
    ASSERT_EQ(found.has_value(), !apart);
    if (apart) return;
    ++met;
    const auto truth = exact.squared_depth();
    ASSERT_GE(found->lower, 0);
    ASSERT_LE(compare_length(found->lower, truth), 0);
    ASSERT_GE(compare_length(found->upper, truth), 0);
    ASSERT_LE(found->upper - found->lower, 1e-12 * found->upper + 1e-13 * kReach);
    const Double3& n = found->normal;
    ASSERT_NEAR(std::hypot(n.x, n.y, n.z), 1, 1e-15);
    const Double3 &p = found->witness_a, &q = found->witness_b;
    ASSERT_NEAR(p.x, q.x + found->upper * n.x, 1e-13 * kReach);
    ASSERT_NEAR(p.y, q.y + found->upper * n.y, 1e-13 * kReach);
    ASSERT_NEAR(p.z, q.z + found->upper * n.z, 1e-13 * kReach);
    ASSERT_LE(outside(p, pair.a), 1e-12 * kReach);
    ASSERT_LE(outside(q, pair.placed), 1e-12 * kReach);
}

// By the definition: the least way along any direction that can be the shortest.
TEST(ConvexPenetrationLaws, GridHullsAreAsDeepAsByDefinition) {
    std::mt19937 random(20240603);
    int met = 0;
    for (int i = 0; i < 40000; ++i) {
        SCOPED_TRACE(i);
        ask<Integer128>(grid_pair(random), random, met);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(met, 12'000);
    EXPECT_LT(met, 28'000);
}

// The same in exact numbers.
TEST(ConvexPenetrationLaws, FineHullsAreAsDeepAsByDefinition) {
    std::mt19937 random(20240604);
    int met = 0;
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        ask<ExactNumber>(fine_pair(random), random, met);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(met, 180);
    EXPECT_LT(met, 420);
}

// Of needles and plates, where the normals of slivers decide how near the bounds are.
TEST(ConvexPenetrationLaws, ThinHullsAreAsDeepAsByDefinition) {
    std::mt19937 random(20240607);
    int met = 0;
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        ask<ExactNumber>(thin_pair(random), random, met);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(met, 180);
    EXPECT_LT(met, 420);
}

}  // namespace
}  // namespace cdprep::test
