// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "support/exact_hull_pair.h"

namespace cdprep::test {

/// Expects three facts of hulls at the distance `truth`. The bounds contain it, the bounds are
/// narrow, and the distance between the witnesses is the upper bound. A - B must lie within 14
/// of the origin.
template <class Number, class Found>
void expect_distance(const Found& found, const SquaredLength<Number>& truth) {
    constexpr double kReach = 14;
    ASSERT_GT(found.lower, 0);
    ASSERT_LE(compare_length(found.lower, truth), 0);
    ASSERT_GE(compare_length(found.upper, truth), 0);
    ASSERT_LE(found.upper - found.lower, 1e-12 * found.upper + 1e-14 * kReach);
    const Double3 &p = found.witness_a, &q = found.witness_b;
    ASSERT_NEAR(std::hypot(p.x - q.x, p.y - q.y, p.z - q.z), found.upper, 1e-14 * kReach);
}

}  // namespace cdprep::test
