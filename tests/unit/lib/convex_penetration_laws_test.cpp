// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_penetration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/exact_hull_pair.h"
#include "support/hull_pairs.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

/// Holds the depth against the truth.
template <class Number>
void ask(const HullPair& pair, std::mt19937& random) {
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
}

// By the definition: the least way along any direction that can be the shortest.
TEST(ConvexPenetrationLaws, GridHullsAreAsDeepAsByDefinition) {
    std::mt19937 random(20240603);
    for (int i = 0; i < 40000; ++i) {
        SCOPED_TRACE(i);
        ask<Integer128>(grid_pair(random), random);
        if (HasFatalFailure()) return;
    }
}

// The same in exact numbers.
TEST(ConvexPenetrationLaws, FineHullsAreAsDeepAsByDefinition) {
    std::mt19937 random(20240604);
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        ask<ExactNumber>(fine_pair(random), random);
        if (HasFatalFailure()) return;
    }
}

// Of needles and plates, where the normals of slivers decide how near the bounds are.
TEST(ConvexPenetrationLaws, ThinHullsAreAsDeepAsByDefinition) {
    std::mt19937 random(20240607);
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        ask<ExactNumber>(thin_pair(random), random);
        if (HasFatalFailure()) return;
    }
}

}  // namespace
}  // namespace cdprep::test
