// SPDX-License-Identifier: MIT
#include "repair/test_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace cdprep::mesh {
namespace {

/// A strip of triangles along x. Each has a corner at y = 1.
struct TestStrip {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> part;

    explicit TestStrip(std::uint32_t count) : part(count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            positions.insert(positions.end(), {{1.0 * i, 0, 0}, {i + 0.5, 0, 0}, {1.0 * i, 1, 0}});
            triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
        }
        std::iota(part.begin(), part.end(), 0U);
    }

    [[nodiscard]] std::optional<int> find(const NumberAt& number_at,
                                          const StopCheck& stop = {}) const {
        return find_number_at_part(positions, triangles, part, number_at, stop);
    }
};

// Each test takes time for all triangles of the others: without a limit, time would be quadratic.
TEST(TestPoints, AreLimitedHoweverManyTrianglesThereAre) {
    std::size_t tests = 0;
    const NumberAt nothing = [&](const Double3&) {
        ++tests;
        return std::nullopt;
    };
    EXPECT_EQ(TestStrip(50'000).find(nothing), std::nullopt);
    EXPECT_EQ(tests, 3 * kMostTestPoints);
    tests = 0;
    EXPECT_EQ(TestStrip(1).find(nothing), std::nullopt);
    EXPECT_EQ(tests, 9U);
    tests = 0;
    EXPECT_EQ(TestStrip(50'000).find(nothing, [] { return true; }), std::nullopt);
    EXPECT_EQ(tests, 1U);
}

// The last hundredth of a part may be all that is off the others.
TEST(TestPoints, ComeFromTheWholePart) {
    const auto found = TestStrip(50'000).find(
        [](const Double3& p) { return p.x > 49'500 ? std::optional(7) : std::nullopt; });
    EXPECT_EQ(found, 7);
}

TEST(TestPoints, LieInEdgesAndTrianglesToo) {
    const TestStrip strip(1);
    const auto find_at = [&](const Double3& place) {
        return strip.find(
            [&](const Double3& p) { return p == place ? std::optional(-2) : std::nullopt; });
    };
    EXPECT_EQ(find_at({0.25, 0.5, 0}), -2) << "the middle of an edge";
    EXPECT_EQ(find_at({0.125, 0.5, 0}), -2) << "within the triangle";
    EXPECT_EQ(find_at({0.25, 0.125, 0}), std::nullopt);
}

// A rounded point may lie on the wrong side of a wall.
TEST(TestPoints, AreExact) {
    TestStrip strip(1);
    strip.positions = {{0, 0, 0}, {std::nextafter(1.0, 2.0), 0, 0}, {2, 1, 0}};
    std::size_t tests = 0;
    const auto found = strip.find([&](const Double3&) {
        ++tests;
        return std::nullopt;
    });
    EXPECT_EQ(found, std::nullopt);
    EXPECT_EQ(tests, 5U) << "three corners and the middles of two edges are doubles";
}

}  // namespace
}  // namespace cdprep::mesh
