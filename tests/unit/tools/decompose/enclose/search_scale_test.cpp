// SPDX-License-Identifier: MIT
#include "decompose/enclose/search_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/meshes.h"
#include "unit/tools/hull_flaw.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using Points = std::vector<Double3>;

constexpr double kLeast = std::numeric_limits<double>::denorm_min();

Points cube_of(double side) {
    return test::moved_by(test::unit_cube(), side, {}).positions;
}

bool is_needed(const Points& points) {
    return SearchScale(points).is_needed();
}

TEST(SearchScale, IsNotNeededAtUsualSizes) {
    EXPECT_FALSE(is_needed(cube_of(1)));
    EXPECT_FALSE(is_needed(cube_of(0x1p-64)));
    EXPECT_FALSE(is_needed(cube_of(0x1p64)));
    EXPECT_TRUE(is_needed(cube_of(0x1p-65)));
    EXPECT_TRUE(is_needed(cube_of(0x1p65)));
    EXPECT_FALSE(is_needed({{1, 2, 3}, {1, 2, 4}}));
    EXPECT_TRUE(is_needed({{1, 2, 3}}));
    EXPECT_TRUE(is_needed({{1, 0, 0}, {1, 0, 1e-300}}));
}

// Exact both ways: the largest coordinate is between 1 and 2 on the way.
TEST(SearchScale, MapsPointsToUsualSizeAndBack) {
    for (const double side : {1e-310, 3e-200, 7e30, 1e160, 0x1p1000}) {
        ConvexHull hull = convex_hull(cube_of(side));
        const SearchScale scale(hull.points);
        const ConvexHull inside = scale.inwards(hull);
        for (const Double3& p : inside.points) {
            for (const double x : {p.x, p.y, p.z}) EXPECT_TRUE(x == 0 || (x >= 1 && x < 2)) << x;
        }
        const OuterHull outer = scale.outwards(inside);
        EXPECT_EQ(outer.growth, 0);
        EXPECT_EQ(outer.hull.points, hull.points);
        EXPECT_EQ(outer.hull.facets, hull.facets);
        EXPECT_TRUE(outer.hull.numbers.empty());
    }
}

// A length of any size is one of a search: no infinite error is asked for.
TEST(SearchScale, LengthsStayFinite) {
    const SearchScale small(cube_of(1e-300));
    EXPECT_EQ(small.inwards(1e300), std::numeric_limits<double>::max());
    const SearchScale large(cube_of(0x1p1000));
    EXPECT_EQ(large.inwards(1e-300), 0);
    EXPECT_EQ(large.inwards(0x1p999), 0.5);
}

/// Sevenths, of which a subnormal number can hold few.
HullError sevenths() {
    HullError error;
    error.lower = 1.0 / 7;
    error.upper = 2.0 / 7;
    return error;
}

TEST(SearchScale, BoundsAreRoundedOutwards) {
    const HullError of_units = SearchScale(cube_of(4 * kLeast)).outwards(sevenths());
    EXPECT_EQ(of_units.lower, 0);           // of 0.57 units
    EXPECT_EQ(of_units.upper, 2 * kLeast);  // of 1.14
    const HullError large = SearchScale(cube_of(0x1p700)).outwards(sevenths());
    EXPECT_EQ(large.lower, 0x1p700 / 7);
    EXPECT_EQ(large.upper, 0x1p701 / 7);
    const HullError none = SearchScale(cube_of(kLeast)).outwards(HullError{});
    EXPECT_EQ(none.lower, 0);
    EXPECT_EQ(none.upper, 0);
}

/// Whether a hull in model units, of subnormal size, holds points of a search.
bool holds_all(const OuterHull& outer, const Points& points, int exponent) {
    ConvexHull hull = outer.hull;
    for (Double3& p : hull.points) {
        p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
    }
    return std::all_of(points.begin(), points.end(),
                       [&](const Double3& p) { return test::holds(hull, p); });
}

// Between units of the least double, a hull grows to whole ones: it holds the exact points, and
// none of its own is farther away than it says.
TEST(SearchScale, HullsAmongSubnormalNumbersGrow) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> at(0, 1);
    const SearchScale scale(cube_of(8 * kLeast));  // 1 is 8 units
    for (int round = 0; round < 30; ++round) {
        Points points;
        for (int i = 0; i < 20; ++i) {
            const double x = at(random), y = at(random);
            points.push_back({x, y, at(random)});
        }
        const OuterHull outer = scale.outwards(convex_hull(points));
        EXPECT_EQ(outer.hull.dimension, 3);
        EXPECT_TRUE(holds_all(outer, points, 1071));
        EXPECT_GE(outer.growth, kLeast);
        EXPECT_LE(outer.growth, 3 * kLeast);
        for (const Double3& p : outer.hull.points) {
            for (const double x : {p.x, p.y, p.z}) EXPECT_TRUE(x >= 0 && x <= 8 * kLeast);
        }
    }
}

// The speck at the corner is lost on the way: what is found may be off by that much.
TEST(SearchScale, OfVeryDifferentCoordinatesCountsWhatIsLost) {
    Points points = cube_of(0x1p1000);
    const double speck = 0x1.8p-75;
    points.push_back({speck, speck, speck});
    const SearchScale scale(points);
    mesh::Mesh mesh;
    mesh.positions = points;
    const Points inside = scale.inwards(mesh).positions;
    EXPECT_NE(std::ldexp(inside.back().x, 1000), speck);
    const OuterHull outer = scale.outwards(convex_hull(inside));
    for (const Double3& p : points) EXPECT_TRUE(test::holds(outer.hull, p));
    EXPECT_GT(outer.growth, 0);
    EXPECT_LE(outer.growth, 0x1p951);
    EXPECT_GE(scale.outwards(HullError{}).upper, 0x1p-75);
}

// The plane x = 1 is moved to 0 and back.
TEST(SearchScale, AxesWithoutExtentDoNotCount) {
    const Points points = {{1, 0, 0}, {1, 8e-323, 0}, {1, 0, 4e-323}};
    const SearchScale scale(points);
    const ConvexHull hull = convex_hull(points);
    const ConvexHull inside = scale.inwards(hull);
    for (const Double3& p : inside.points) {
        EXPECT_EQ(p.x, 0);
        EXPECT_TRUE(p.y == 0 || p.y >= 1);
    }
    const OuterHull outer = scale.outwards(inside);
    EXPECT_EQ(outer.hull.points, hull.points);
    EXPECT_EQ(outer.growth, 0);
    const OuterHull thick =
        scale.outwards(convex_hull(Points{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25, 0, 0}}));
    EXPECT_GE(thick.growth, 0x1p-53);
    EXPECT_LE(thick.growth, 0x1p-51);
}

}  // namespace
}  // namespace cdprep::convex
