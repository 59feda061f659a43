// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "support/exact_distance.h"

#include "exact/exact_within.h"

namespace cdprep::test {
namespace {

/// Corners of a point, segment or triangle as a triangle.
Corners filled(const std::vector<Double3>& points) {
    return {points.front(), points[points.size() / 2], points.back()};
}

/// By the definition, in exact rational numbers.
bool truth_of(const std::vector<Double3>& points, const Corners& t, double distance) {
    const ExactRational squared = points.size() == 1 ? exact_squared_distance(points[0], t)
                                                     : exact_squared_distance(filled(points), t);
    return squared <= exact_square(distance);
}

Double3 grid_point(std::mt19937& random, int reach) {
    std::uniform_int_distribution<int> grid(-reach, reach);
    const double x = grid(random), y = grid(random), z = grid(random);
    return {x, y, z};
}

Double3 fine_point(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-1, 1);
    const double x = place(random), y = place(random), z = place(random);
    return {x, y, z};
}

// Squares of grid distances are small fractions: whole distances are met often.
TEST(ExactWithinLaws, AgreesWithRationalsOnACoarseGrid) {
    std::mt19937 random(81);
    int yes = 0, ties = 0;
    constexpr int kCases = 15'000;
    for (int i = 0; i < kCases; ++i) {
        std::vector<Double3> points(1 + i % 3);
        for (Double3& p : points) p = grid_point(random, 3);
        Corners t = {grid_point(random, 3), grid_point(random, 3), grid_point(random, 3)};
        if (random() % 8 == 0) t[2] = t[random() % 2];
        if (random() % 8 == 0) points.back() = points.front();
        const double distance = static_cast<double>(random() % (points.size() == 1 ? 7 : 4));
        const bool truth = truth_of(points, t, distance);
        ASSERT_EQ(is_within_exactly(points, t, distance), truth) << "seed 81, case " << i;
        const bool touch = triangles_touch(filled(points), t);
        if (!touch && distance > 0) {
            ASSERT_EQ(is_within_in_integers(points, t, distance), truth) << "seed 81, case " << i;
            const double less = std::nextafter(distance, 0.0);
            ASSERT_EQ(is_within_exactly(points, t, less), truth_of(points, t, less));
            ties += truth && !truth_of(points, t, less) ? 1 : 0;
        }
        yes += truth ? 1 : 0;
    }
    EXPECT_GT(yes, kCases * 3 / 10);
    EXPECT_LT(yes, kCases * 7 / 10);
    EXPECT_GT(ties, 50);
}

TEST(ExactWithinLaws, AgreesWithRationalsOnFineNumbers) {
    std::mt19937 random(82);
    int yes = 0;
    constexpr int kCases = 600;
    for (int i = 0; i < kCases; ++i) {
        std::vector<Double3> points(1 + i % 3);
        for (Double3& p : points) p = fine_point(random);
        const Corners t = {fine_point(random), fine_point(random), fine_point(random)};
        // As near to the distance as double can tell, and one step nearer.
        const ExactRational squared = points.size() == 1
                                          ? exact_squared_distance(points[0], t)
                                          : exact_squared_distance(filled(points), t);
        double distance = static_cast<double>(std::sqrt(squared.approximation()));
        if (i % 2 == 0) distance = std::nextafter(distance, 0.0);
        const bool truth = truth_of(points, t, distance);
        ASSERT_EQ(is_within_exactly(points, t, distance), truth) << "seed 82, case " << i;
        yes += truth ? 1 : 0;
    }
    EXPECT_GT(yes, kCases * 3 / 10);
    EXPECT_LT(yes, kCases * 7 / 10);
}

// By symmetry: a tangent sphere stays tangent at every size; 3-4-5 makes it exact.
TEST(ExactWithinLaws, TangentStaysTangentAtEverySize) {
    for (const int exponent : {-1074, -1000, -300, 0, 300, 900, 1020}) {
        const auto at = [&](double x) { return std::ldexp(x, exponent); };
        const Corners floor = {{{at(-8), at(-8), 0}, {at(8), at(-8), 0}, {0, at(8), 0}}};
        const std::vector<Double3> centre = {{0, 0, at(5)}};
        EXPECT_TRUE(is_within_exactly(centre, floor, at(5))) << exponent;
        EXPECT_FALSE(is_within_exactly(centre, floor, std::nextafter(at(5), 0.0))) << exponent;
        const Corners corner = {{{at(3), at(4), 0}, {at(8), at(8), 0}, {at(8), at(4), 0}}};
        const std::vector<Double3> origin = {{0, 0, 0}};
        EXPECT_TRUE(is_within_exactly(origin, corner, at(5))) << exponent;
        EXPECT_FALSE(is_within_exactly(origin, corner, std::nextafter(at(5), 0.0))) << exponent;
    }
}

// By hand: sizes that no scaling brings together, and distances that are none.
TEST(ExactWithinLaws, SpreadSizesAndOddDistances) {
    const Corners t = {{{0x1p1000, 0, 0}, {0x1p1000, 0x1p-1074, 0}, {0x1p1000, 0, 1}}};
    const std::vector<Double3> p = {{0x1p-1074, 0, 0}};
    EXPECT_TRUE(is_within_exactly(p, t, 0x1p1000));
    EXPECT_FALSE(is_within_exactly(p, t, std::nextafter(0x1p1000, 0.0)));
    EXPECT_FALSE(is_within_exactly(p, t, -1));
    EXPECT_FALSE(is_within_exactly(p, t, std::nan("")));
    EXPECT_TRUE(is_within_exactly(p, t, std::numeric_limits<double>::infinity()));
    const std::vector<Double3> far = {{1.7e308, -1.7e308, 1.7e308}};
    const Corners behind = {{{-1.7e308, -1.7e308, 1.7e308}, {0, 0, 0}, {0, 1, 0}}};
    EXPECT_FALSE(is_within_exactly(far, behind, 1e300));
    EXPECT_TRUE(is_within_exactly(far, behind, 1.79e308) == truth_of(far, behind, 1.79e308));
}

}  // namespace
}  // namespace cdprep::test
