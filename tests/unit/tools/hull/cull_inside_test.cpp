// SPDX-License-Identifier: MIT
#include "hull/cull_inside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "hull/exact_hull.h"
#include "support/run_threads.h"
#include "unit/tools/recorded_text.h"

namespace cdprep::convex {
namespace {

using Points = std::vector<Double3>;

Points random_points(int count, const std::function<Double3(std::mt19937&)>& draw) {
    std::mt19937 random(17);
    Points points;
    for (int i = 0; i < count; ++i) points.push_back(draw(random));
    return points;
}

Double3 in_cube(std::mt19937& random) {
    std::uniform_real_distribution<double> side(-1, 1);
    const double x = side(random), y = side(random);
    return {x, y, side(random)};
}

Double3 on_sphere(std::mt19937& random) {
    std::normal_distribution<double> side;
    const double x = side(random), y = side(random), z = side(random);
    const double length = std::sqrt(x * x + y * y + z * z);
    return {x / length, y / length, z / length};
}

/// A cube's points, moved and turned so that they are thin, far away, tiny or huge.
std::vector<Points> hard_sets() {
    std::vector<Points> sets;
    for (const double thickness : {1.0, 1e-3, 1e-6, 1e-9, 1e-14}) {
        for (const double away : {0.0, 1e3, 1e12}) {
            Points points = random_points(6'000, in_cube);
            for (Double3& p : points) p = {p.x + p.y + away, p.x - p.y, p.z * thickness + p.x};
            sets.push_back(points);
        }
    }
    for (const int exponent : {-1060, -600, -30, 30, 600, 1022}) {
        Points points = random_points(3'000, in_cube);
        for (Double3& p : points) {
            p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
        }
        sets.push_back(points);
    }
    sets.push_back(random_points(3'000, on_sphere));
    Points grid = random_points(20'000, in_cube);
    for (Double3& p : grid) p = {std::round(8 * p.x), std::round(8 * p.y), std::round(8 * p.z)};
    sets.push_back(grid);
    return sets;
}

// Law: what is left has the hull of all; so no extreme point was dropped.
TEST(CullInside, LeavesTheHullAsItIs) {
    for (const Points& points : hard_sets()) {
        const std::vector<std::uint32_t> outer = cull_inside(points, serial_for);
        EXPECT_TRUE(std::is_sorted(outer.begin(), outer.end()));
        const ConvexHull all = exact_hull(points);
        for (const std::uint32_t number : all.numbers) {
            ASSERT_TRUE(std::binary_search(outer.begin(), outer.end(), number));
        }
    }
}

// It would be no use otherwise.
TEST(CullInside, DropsMostOfWhatIsWellInside) {
    for (const int count : {6'000, 100'000}) {
        const Points points = random_points(count, in_cube);
        const auto outer = cull_inside(points, serial_for);
        EXPECT_LT(outer.size(), points.size() / 10);
    }
}

// All points of a sphere are extreme, but for those that rounding put inside.
TEST(CullInside, KeepsPointsOfASphere) {
    const Points points = random_points(5'000, on_sphere);
    EXPECT_EQ(cull_inside(points, serial_for).size(), points.size());
}

// Where doubles have no room for the proof, nothing is dropped.
TEST(CullInside, KeepsAllWhereSizesAreExtreme) {
    for (const double size : {1e-200, 1e200}) {
        Points points = random_points(1'000, in_cube);
        for (Double3& p : points) p = {p.x * size, p.y * size, p.z * size};
        EXPECT_EQ(cull_inside(points, serial_for).size(), points.size());
    }
}

// No rounding differs between machines: what is left tells how well each pass culls.
TEST(CullInside, LeavesWhatIsRecorded) {
    std::vector<Points> sets = hard_sets();
    for (const int count : {20, 700, 40'000, 100'003}) {
        sets.push_back(random_points(count, in_cube));
        for (Double3& p : sets.back()) p = {p.x, p.y + 4 * p.x, 9 * p.z - 3};
    }
    std::string text;
    for (const Points& points : sets) {
        const std::vector<std::uint32_t> outer = cull_inside(points, serial_for);
        std::uint64_t sum = 0;
        for (const std::uint32_t number : outer) sum = 31 * sum + number;
        text += std::to_string(outer.size()) + " of " + std::to_string(points.size()) + ", " +
                std::to_string(sum) + "\n";
    }
    EXPECT_EQ(test::hash_of_text(text), 0xdca9ed865ac7fc43) << text;
}

TEST(CullInside, ThreadsChangeNothing) {
    const Points points = random_points(50'000, in_cube);
    EXPECT_EQ(cull_inside(points, serial_for), cull_inside(points, test::run_threads));
}

}  // namespace
}  // namespace cdprep::convex
