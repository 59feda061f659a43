// SPDX-License-Identifier: MIT
#include "hull/enclosing_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/meshes.h"
#include "unit/tools/hull_flaw.h"
#include "unit/tools/recorded_text.h"

namespace cdprep::convex {
namespace {

using Points = std::vector<Double3>;

/// Whether every point is behind or on every facet, by exact numbers.
bool encloses(const ConvexHull& hull, const Points& points) {
    for (const auto& facet : hull.facets) {
        const test::FilteredPlane plane(hull.points[facet[0]], hull.points[facet[1]],
                                        hull.points[facet[2]]);
        for (const Double3& p : points) {
            if (plane.side(p) > 0) return false;
        }
    }
    return hull.dimension == 3;
}

/// A hull in its own right, whatever its points are.
std::string own_flaw(ConvexHull hull) {
    hull.numbers.resize(hull.points.size());
    for (std::uint32_t i = 0; i < hull.numbers.size(); ++i) hull.numbers[i] = i;
    return test::hull_flaw(hull.points, hull);
}

/// How far from a convex surface's points `p` is in the directions of many planes: a lower
/// bound of its distance to the hull.
double farthest_beyond(const Points& inner, const Points& outer, std::mt19937& random) {
    std::normal_distribution<double> side;
    double most = 0;
    for (int i = 0; i < 2'000; ++i) {
        const double x = side(random), y = side(random), z = side(random);
        const double length = std::sqrt(x * x + y * y + z * z);
        double of_inner = -1e300, of_outer = -1e300;
        for (const Double3& p : inner) of_inner = std::max(of_inner, p.x * x + p.y * y + p.z * z);
        for (const Double3& p : outer) of_outer = std::max(of_outer, p.x * x + p.y * y + p.z * z);
        most = std::max(most, (of_outer - of_inner) / length);
    }
    return most;
}

std::vector<Points> point_sets() {
    std::mt19937 random(2);
    std::normal_distribution<double> fine;
    std::vector<Points> sets = {test::icosphere(3).positions};
    for (const double flatness : {1.0, 1e-2, 1e-8, 1e-15, 0.0}) {
        for (const double away : {0.0, 1e6}) {
            Points points;
            for (int i = 0; i < 3'000; ++i) {
                const double x = fine(random), y = fine(random);
                points.push_back({x + away, y - x, flatness * fine(random) + 0.5 * y});
            }
            sets.push_back(points);
        }
    }
    Points polygon;
    for (int i = 0; i < 100; ++i) {
        const double turn = i * std::numbers::pi / 50;
        polygon.push_back({std::cos(turn), std::sin(turn), 2});
    }
    sets.push_back(polygon);
    return sets;
}

TEST(EnclosingHull, ContainsAllPointsExactlyWithAtMostAsManyVertices) {
    int asked = 0;
    for (const Points& points : point_sets()) {
        const ConvexHull exact = convex_hull(points);
        for (const std::uint32_t most : {4U, 7U, 8U, 16U, 32U}) {
            if (exact.points.size() <= most) continue;
            ++asked;
            const auto outer = enclosing_hull(exact, most);
            ASSERT_TRUE(outer);
            EXPECT_LE(outer->hull.points.size(), most);
            EXPECT_TRUE(outer->hull.numbers.empty());
            EXPECT_TRUE(encloses(outer->hull, points));
            EXPECT_EQ(own_flaw(outer->hull), "");
        }
    }
    EXPECT_GE(asked, 55);
}

// The bound is one: no direction shows more. And it is near the truth: some direction of
// those asked shows most of it.
TEST(EnclosingHull, DistanceIsABoundNearTheTruth) {
    std::mt19937 random(3);
    for (const Points& points : point_sets()) {
        const ConvexHull exact = convex_hull(points);
        const auto outer = enclosing_hull(exact, 16);
        ASSERT_TRUE(outer);
        const double seen = farthest_beyond(exact.points, outer->hull.points, random);
        EXPECT_GE(outer->distance * (1 + 1e-9), seen);
        EXPECT_LE(outer->distance, 1.3 * seen);
    }
}

// By hand: few enough points are all there is.
TEST(EnclosingHull, OfFewPointsIsExact) {
    const ConvexHull cube = convex_hull(test::unit_cube().positions);
    const auto outer = enclosing_hull(cube, 8);
    ASSERT_TRUE(outer);
    EXPECT_EQ(outer->distance, 0);
    EXPECT_EQ(outer->hull.facets, cube.facets);
    EXPECT_EQ(outer->hull.numbers, cube.numbers);
    EXPECT_TRUE(enclosing_hull(convex_hull(Points{{1, 2, 3}}), 4));
    EXPECT_TRUE(enclosing_hull(ConvexHull{}, 4));
}

// Law, and by a figure known of spheres.
TEST(EnclosingHull, MoreVerticesCostNoDistance) {
    const ConvexHull exact = convex_hull(test::icosphere(4).positions);
    double before = 10;
    for (const std::uint32_t most : {4U, 8U, 16U, 32U, 64U, 128U, 256U}) {
        const auto outer = enclosing_hull(exact, most);
        ASSERT_TRUE(outer);
        EXPECT_LT(outer->distance, before);
        // A sphere's best polytopes with V corners are about 5 / V away.
        if (most >= 16) {
            EXPECT_LT(outer->distance, 12.0 / most);
        }
        before = outer->distance;
    }
}

// That they enclose, and how closely, is asked above: this tells how well the search chooses.
TEST(EnclosingHull, DistancesAreAsRecorded) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> side(-1, 1);
    std::vector<Points> sets = {test::icosphere(2).positions, {}, {}, {}};
    for (int i = 0; i < 400; ++i) {
        const double x = side(random), y = side(random), z = side(random);
        sets[1].push_back({x, y, z});
        sets[2].push_back({x + 100, y + x, 0.01 * z});
        if (x * x + y * y < 1) sets[3].push_back({5 * x, y, 2 * z * (1 - x * x - y * y)});
    }
    std::string text;
    for (const Points& points : sets) {
        const ConvexHull exact = convex_hull(points);
        for (const std::uint32_t most : {4U, 6U, 7U, 8U, 9U, 12U, 20U, 33U}) {
            const auto outer = enclosing_hull(exact, most);
            ASSERT_TRUE(outer);
            text += std::to_string(outer->hull.points.size()) + " corners, " +
                    std::to_string(outer->hull.facets.size()) + " facets, " +
                    std::to_string(outer->distance) + "\n";
        }
    }
    EXPECT_EQ(test::hash_of_text(text), 0x496c9fc62cde8139) << text;
}

// Among subnormal numbers only whole units are left: it is looser, and a bound nevertheless.
TEST(EnclosingHull, OfAnySizeHoldsAllPoints) {
    const Points points = test::icosphere(2).positions;
    for (const int exponent : {-1070, -1030, -700, 700, 999}) {
        Points at_size;
        for (const Double3& p : points) {
            at_size.push_back(
                {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)});
        }
        const ConvexHull exact = convex_hull(at_size);
        for (const std::uint32_t most : {4U, 9U, 20U}) {
            const auto outer = enclosing_hull(exact, most);
            ASSERT_TRUE(outer) << exponent << " " << most;
            EXPECT_LE(outer->hull.points.size(), most);
            EXPECT_TRUE(encloses(outer->hull, at_size)) << exponent << " " << most;
            EXPECT_GT(outer->distance, 0);
            EXPECT_LE(std::ldexp(outer->distance, -exponent), 4) << exponent << " " << most;
        }
    }
}

TEST(EnclosingHull, ScalingByPowersOfTwoScalesIt) {
    const Points points = test::icosphere(2).positions;
    const auto outer = enclosing_hull(convex_hull(points), 20);
    for (const int exponent : {-300, 300}) {
        Points large = points;
        for (Double3& p : large) {
            p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
        }
        const auto outer_large = enclosing_hull(convex_hull(large), 20);
        ASSERT_TRUE(outer && outer_large);
        EXPECT_EQ(outer_large->hull.facets, outer->hull.facets);
        EXPECT_NEAR(std::ldexp(outer_large->distance, -exponent), outer->distance, 1e-12);
    }
}

}  // namespace
}  // namespace cdprep::convex
