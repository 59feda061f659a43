// SPDX-License-Identifier: MIT
#include "decompose/enclose/drop_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "unit/tools/hull_flaw.h"

namespace cdprep::convex {
namespace {

constexpr double kBrink = 1e-9;  ///< of heights near the limit, where two ways of rounding differ

Double3 normal_of(const std::array<Double3, 3>& t) {
    const auto& [a, b, c] = t;
    const Double3 u = {b.x - a.x, b.y - a.y, b.z - a.z}, v = {c.x - a.x, c.y - a.y, c.z - a.z};
    const Double3 n = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const double length = std::hypot(n.x, n.y, n.z);
    return {n.x / length, n.y / length, n.z / length};
}

/// Returns how far a point stands out of the hull of all others, found without neighbours.
double height_above_others(const ConvexHull& hull, std::size_t point) {
    std::vector<Double3> others = hull.points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(point));
    const ConvexHull rest = convex_hull(others);
    const Double3& p = hull.points[point];
    double most = 0;
    for (const auto& [a, b, c] : rest.facets) {
        const Double3& at = rest.points[a];
        const Double3 n = normal_of({at, rest.points[b], rest.points[c]});
        most = std::max(most, n.x * (p.x - at.x) + n.y * (p.y - at.y) + n.z * (p.z - at.z));
    }
    return most;
}

std::size_t points_lower_than(const ConvexHull& hull, double height) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < hull.points.size(); ++i) {
        count += height_above_others(hull, i) < height ? 1 : 0;
    }
    return count;
}

/// Returns a lower bound of how far `outer` sticks out of `inner`: the excess of its support.
double excess_along(const ConvexHull& inner, const ConvexHull& outer, std::mt19937& random) {
    std::normal_distribution<double> side;
    const auto farthest = [](const ConvexHull& hull, const Double3& d) {
        double most = -1e300;
        for (const Double3& p : hull.points)
            most = std::max(most, p.x * d.x + p.y * d.y + p.z * d.z);
        return most;
    };
    double most = 0;
    for (int i = 0; i < 2'000; ++i) {
        Double3 d = {side(random), side(random), side(random)};
        const double length = std::hypot(d.x, d.y, d.z);
        d = {d.x / length, d.y / length, d.z / length};
        most = std::max(most, farthest(outer, d) - farthest(inner, d));
    }
    return most;
}

std::vector<Double3> box_corners(const Double3& size) {
    std::vector<Double3> points;
    for (unsigned k = 0; k < 8; ++k) {
        points.push_back(
            {(k & 1U) == 0 ? 0 : size.x, (k & 2U) == 0 ? 0 : size.y, (k & 4U) == 0 ? 0 : size.z});
    }
    return points;
}

/// A box, and points in the middle of its edges that stick out a little.
ConvexHull box_with_bent_edges(const Double3& size, double out) {
    std::vector<Double3> points = box_corners(size);
    for (unsigned k = 0; k < 4; ++k) {
        const double y = (k & 1U) == 0 ? -out : size.y + out;
        const double z = (k & 2U) == 0 ? -out : size.z + out;
        points.push_back({size.x / 2, y, z});
    }
    return convex_hull(points);
}

// The corners of a box stand out by more than a tenth of its sides.
TEST(DropPoints, LeavesABoxAsItIs) {
    const ConvexHull box = convex_hull(box_corners({1, 2, 3}));
    const DroppedPoints dropped = drop_points(box, {.height = 0.1, .growth = 1});
    EXPECT_EQ(dropped.hull.points, box.points);
    EXPECT_EQ(dropped.hull.facets, box.facets);
    EXPECT_EQ(dropped.growth, 0);
    EXPECT_EQ(dropped.low, 0U);
    EXPECT_EQ(dropped.moved, 0U);
}

// Twelve points become eight, which contain the twelve and lie little farther out.
TEST(DropPoints, StraightensBentEdges) {
    for (const Double3& size : {Double3{1, 1, 1}, Double3{10, 1, 0.1}, Double3{1, 1, 30}}) {
        for (const double out : {1e-14, 1e-9, 1e-5, 1e-3}) {
            const double scale = std::min({size.x, size.y, size.z});
            const ConvexHull hull = box_with_bent_edges(size, out * scale);
            ASSERT_EQ(hull.points.size(), 12U);
            const DroppedPoints dropped =
                drop_points(hull, {.height = 0.05 * scale, .growth = 0.05 * scale});
            EXPECT_EQ(dropped.hull.points.size(), 8U) << out;
            EXPECT_EQ(dropped.low, 0U);
            EXPECT_EQ(dropped.moved, 4U);
            for (const Double3& p : hull.points) EXPECT_TRUE(test::holds(dropped.hull, p));
            EXPECT_GT(dropped.growth, 0);
            EXPECT_LT(dropped.growth, 6 * out * scale + 1e-13);
        }
    }
}

TEST(DropPoints, GrowsByLessThanAllowed) {
    const ConvexHull hull = box_with_bent_edges({1, 1, 1}, 1e-3);
    for (const double growth : {0.0, 1e-9, 1e-4}) {
        const DroppedPoints dropped = drop_points(hull, {.height = 0.05, .growth = growth});
        EXPECT_EQ(dropped.hull.points, hull.points) << growth;
        EXPECT_EQ(dropped.low, 4U);
        EXPECT_EQ(dropped.growth, 0);
    }
}

TEST(DropPoints, ReturnsFlatHullsUnchanged) {
    const std::vector<Double3> flat = {{0, 0, 0}, {1, 0, 0}, {2, 1e-9, 0}, {0, 1, 0}};
    const ConvexHull hull = convex_hull(flat);
    ASSERT_EQ(hull.dimension, 2);
    EXPECT_EQ(drop_points(hull, {.height = 1, .growth = 1}).hull.points, hull.points);
}

TEST(DropPoints, KeepsAtLeastATetrahedron) {
    std::mt19937 random(7);
    std::normal_distribution<double> fine;
    std::vector<Double3> points;
    for (int i = 0; i < 30; ++i) points.push_back({fine(random), fine(random), fine(random)});
    const ConvexHull hull = convex_hull(points);
    const DroppedPoints dropped = drop_points(hull, {.height = 1e9, .growth = 1e9});
    EXPECT_GE(dropped.hull.points.size(), 4U);
    EXPECT_LT(dropped.hull.points.size(), hull.points.size());
    for (const Double3& p : hull.points) EXPECT_TRUE(test::holds(dropped.hull, p));
}

/// Balls, disks and needles of random points; near 0, far away, and on a coarse grid.
std::vector<std::vector<Double3>> drawn_sets() {
    std::mt19937 random(3);
    std::normal_distribution<double> fine;
    std::uniform_int_distribution<int> coarse(-6, 6);
    std::vector<std::vector<Double3>> sets;
    for (const double thin : {1.0, 0.05, 20.0}) {
        for (const double away : {0.0, 1e6}) {
            std::vector<Double3> points, grid;
            for (int i = 0; i < 150; ++i) {
                const Double3 p = {fine(random), fine(random), fine(random)};
                const double length = std::hypot(p.x, p.y, p.z);
                points.push_back({away + p.x / length, p.y / length - away, thin * p.z / length});
                grid.push_back(
                    {away + coarse(random), coarse(random) - away, thin * coarse(random)});
            }
            sets.push_back(points);
            sets.push_back(grid);
        }
    }
    return sets;
}

// The hull of every point, and of what is left, is known from the hull of the others.
TEST(DropPoints, FindsEnclosingHullsWithoutLowPoints) {
    std::mt19937 random(5);
    std::size_t before = 0, after = 0, low_before = 0, low_after = 0;
    for (const std::vector<Double3>& points : drawn_sets()) {
        const ConvexHull hull = convex_hull(points);
        const double height = 4 * ignored_height(points);
        const DroppedPoints dropped = drop_points(hull, {.height = height, .growth = 4 * height});
        for (const Double3& p : hull.points) ASSERT_TRUE(test::holds(dropped.hull, p));
        EXPECT_LT(dropped.growth, 4 * height);
        EXPECT_LE(excess_along(hull, dropped.hull, random), dropped.growth * (1 + 1e-9));
        EXPECT_GE(dropped.low, points_lower_than(dropped.hull, height * (1 - kBrink)));
        EXPECT_LE(dropped.low, points_lower_than(dropped.hull, height * (1 + kBrink)));
        before += hull.points.size();
        after += dropped.hull.points.size();
        low_before += points_lower_than(hull, height);
        low_after += dropped.low;
    }
    EXPECT_LT(after, before);
    EXPECT_GT(low_before, before / 10) << "the cases test nothing";
    EXPECT_LT(low_after, after / 20);
}

// PhysX: 0.0007 of half the sum of the sides, here 3.
TEST(IgnoredHeight, FollowsTheBox) {
    EXPECT_GT(ignored_height(box_corners({1, 2, 3})), 0.0007 * 3);
    EXPECT_LT(ignored_height(box_corners({1, 2, 3})), 0.0014 * 3);
    EXPECT_EQ(ignored_height(box_corners({1, 2, 3}), 30),
              10 * ignored_height(box_corners({1, 2, 3})));
    EXPECT_EQ(ignored_height(box_corners({1, 2, 3}), 3), ignored_height(box_corners({1, 2, 3})));
    EXPECT_EQ(ignored_height({}), 0);
}

// The sides of a turned square are cut in eight. Rounding makes cut points corners of the hull,
// which stand out by some roundings. All but the four ends of the sides are low.
TEST(DropPoints, PointsOnSlantedEdgesAreLow) {
    std::size_t low = 0;
    for (int i = 0; i < 50; ++i) {
        std::vector<Double3> points;
        std::size_t ends = 0;
        for (const double z : {0.0, 14.0}) {
            for (int side = 0; side < 4; ++side) {
                const double from = 0.06 * i + 0.01 + side * std::acos(0);
                const double to = from + std::acos(0);
                for (int k = 0; k < 8; ++k) {
                    const double x = 10 * std::cos(from), y = 10 * std::sin(from);
                    points.push_back({x + (10 * std::cos(to) - x) * k / 8,
                                      y + (10 * std::sin(to) - y) * k / 8, 0});
                    points.back().z = z + 0.1 * points.back().x;
                    ends += k == 0 ? 1 : 0;
                }
            }
        }
        const ConvexHull hull = convex_hull(points);
        EXPECT_EQ(drop_points(hull, {.height = 1e-9, .growth = 0}).low, hull.points.size() - ends)
            << i;
        low += hull.points.size() - ends;
    }
    EXPECT_GT(low, 500U);
}

}  // namespace
}  // namespace cdprep::convex
