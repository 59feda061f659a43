// SPDX-License-Identifier: MIT
#include "cdprep/convex_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/exact_hull_pair.h"
#include "support/random_pose.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

using Points = std::vector<Double3>;

/// Turns by which integers stay integers.
std::array<double, 9> quarter_turns(std::mt19937& random) {
    std::array<std::size_t, 3> axis = {0, 1, 2};
    std::shuffle(axis.begin(), axis.end(), random);
    std::array<double, 3> sign{};
    for (double& s : sign) s = (random() & 1) != 0 ? 1 : -1;
    std::array<double, 9> r{};
    for (std::size_t i = 0; i < 3; ++i) r[3 * i + axis[i]] = sign[i];
    const double determinant = r[0] * (r[4] * r[8] - r[5] * r[7]) -
                               r[1] * (r[3] * r[8] - r[5] * r[6]) +
                               r[2] * (r[3] * r[7] - r[4] * r[6]);
    if (determinant < 0) {
        for (std::size_t i = 0; i < 3; ++i) r[i] = -r[i];
    }
    return r;
}

Pose pose_of(const std::array<double, 9>& r, const Double3& t) {
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], t.x, t.y, t.z})
        .value();
}

/// 1 to 6 points of a grid, most often 5 or 6; every fifth set lies in a plane.
Points grid_points(std::mt19937& random) {
    std::uniform_int_distribution<int> coordinate(-4, 4), number(1, 16);
    Points points(static_cast<std::size_t>(std::min(number(random), 6)));
    const bool flat = random() % 5 == 0;
    for (Double3& p : points) {
        p = {double(coordinate(random)), double(coordinate(random)), double(coordinate(random))};
        if (flat) p.z = p.x;
    }
    return points;
}

Points moved_points(const Points& points, const Pose& pose) {
    Points result;
    for (const Double3& p : points) result.push_back(moved(pose, p));
    return result;
}

const Double3& extreme(const Points& points, const Double3& d) {
    return *std::max_element(points.begin(), points.end(), [&](const Double3& p, const Double3& q) {
        return d.x * p.x + d.y * p.y + d.z * p.z < d.x * q.x + d.y * q.y + d.z * q.z;
    });
}

/// Where B goes: anywhere, or so that the two touch along a random direction.
Double3 grid_shift(const Points& a, const Points& b, std::mt19937& random) {
    std::uniform_int_distribution<int> coordinate(-5, 5), direction(-2, 2);
    if (random() % 3 != 0) {
        return {double(coordinate(random)), double(coordinate(random)), double(coordinate(random))};
    }
    const Double3 d = {double(direction(random)), double(direction(random)),
                       double(direction(random))};
    const Double3& p = extreme(a, d);
    const Double3& q = extreme(b, {-d.x, -d.y, -d.z});
    return {p.x - q.x, p.y - q.y, p.z - q.z};
}

ConvexCache nonsense(std::mt19937& random) {
    ConvexCache cache;
    cache.count = static_cast<std::uint32_t>(random() % 6);
    for (std::size_t i = 0; i < 4; ++i) {
        cache.a[i] = static_cast<std::uint32_t>(random() % 7);
        cache.b[i] = static_cast<std::uint32_t>(random() % 7);
    }
    return cache;
}

// The oracle's truth: both bounds against the exact square; every form of the question.
TEST(ConvexDistanceLaws, GridHullsAreAnsweredAsByDefinition) {
    constexpr int kPairs = 100000;
    constexpr double kReach = 14;  // of A - B: two hulls and a shift
    std::mt19937 random(20240601);
    int apart = 0, touching = 0;
    for (int pair = 0; pair < kPairs; ++pair) {
        SCOPED_TRACE(pair);
        const Points a = grid_points(random);
        const Points b = grid_points(random);
        const auto turn = quarter_turns(random);
        const Points turned = moved_points(b, pose_of(turn, {0, 0, 0}));
        const Pose pose = pose_of(turn, grid_shift(a, turned, random));
        const Points placed = moved_points(b, pose);
        const ExactHullPair<Integer128> exact(a, placed);
        const auto truth = exact.squared_distance();
        apart += truth ? 1 : 0;
        if (!truth) touching += sign_of(exact.squared_depth().numerator) == 0 ? 1 : 0;

        const Edges edges = random() % 2 == 0 ? Edges::none : Edges::exact;
        const SmallHull hull_a(a, edges), hull_b(b, edges);
        const ConvexPoints view_a = hull_a.view(), view_b = hull_b.view();
        const Placement placement = Placement::b_moves(pose);
        ConvexCache cache = nonsense(random);
        ASSERT_EQ(convex_collide(view_a, view_b, placement), !truth);
        ASSERT_EQ(convex_collide(view_a, view_b, placement, &cache), !truth);
        ASSERT_EQ(convex_collide(view_a, view_b, placement, &cache), !truth);
        ASSERT_EQ(convex_collide(view_b, view_a, Placement::a_moves(pose)), !truth);
        if (pair % 2 == 0) cache = nonsense(random);
        const auto distance = convex_distance(view_a, view_b, placement, {}, &cache);
        ASSERT_TRUE(distance);
        if (!truth) {
            ASSERT_EQ(distance->upper, 0);
            continue;
        }
        ASSERT_GT(distance->lower, 0);
        ASSERT_LE(compare_length(distance->lower, *truth), 0);
        ASSERT_GE(compare_length(distance->upper, *truth), 0);
        ASSERT_LE(distance->upper - distance->lower, 1e-12 * distance->upper + 1e-14 * kReach);
        ASSERT_FALSE(convex_is_within(view_a, view_b, placement, distance->lower * (1 - 1e-15)));
        ASSERT_TRUE(convex_is_within(view_a, view_b, placement, distance->upper * (1 + 1e-15)));
        ASSERT_EQ(convex_is_within(view_a, view_b, placement, std::nearbyint(distance->upper)),
                  compare_length(std::nearbyint(distance->upper), *truth) >= 0);
    }
    EXPECT_GT(apart, kPairs * 3 / 10);
    EXPECT_LT(apart, kPairs * 7 / 10);
    EXPECT_GT(touching, kPairs / 10);
    EXPECT_GT(kPairs - apart - touching, kPairs / 10);
}

}  // namespace
}  // namespace cdprep::test
