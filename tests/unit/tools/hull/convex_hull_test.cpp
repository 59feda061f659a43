// SPDX-License-Identifier: MIT
#include "hull/convex_hull.h"

#include <gtest/gtest.h>

#include <random>

#include "support/meshes.h"
#include "unit/tools/hull_flaw.h"

namespace cdprep::convex {
namespace {

using test::hull_flaw;
using Points = std::vector<Double3>;
using Numbers = std::vector<std::uint32_t>;

// By hand: nothing has no hull, and says so.
TEST(ConvexHull, NothingHasDimensionMinusOne) {
    const ConvexHull hull = convex_hull({});
    EXPECT_EQ(hull.dimension, -1);
    EXPECT_TRUE(hull.points.empty());
    EXPECT_TRUE(hull.facets.empty());
    EXPECT_EQ(hull.groups, Numbers{0});
}

// C01, by hand: the first of equal points stands for all; -0 equals 0.
TEST(ConvexHull, EqualPointsAreOnePoint) {
    const Points points = {{1, 0.0, 2}, {1, -0.0, 2}, {1, 0.0, 2}};
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.dimension, 0);
    EXPECT_EQ(hull.numbers, Numbers{0});
    EXPECT_EQ(hull_flaw(points, hull), "");
}

// C01, by hand: the ends of a segment, in order of their numbers.
TEST(ConvexHull, CollinearPointsAreASegment) {
    const Points points = {{1, 2, 3}, {3, 6, 9}, {-2, -4, -6}, {0, 0, 0}, {3, 6, 9}};
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.dimension, 1);
    EXPECT_EQ(hull.numbers, (Numbers{1, 2}));
    EXPECT_EQ(hull_flaw(points, hull), "");
}

// C01, by hand: a square's corners; what lies on its border or inside is none.
TEST(ConvexHull, CoplanarPointsAreAPolygonSeenFromBothSides) {
    for (int axis = 0; axis < 3; ++axis) {
        Points points;
        for (int i = 0; i < 9; ++i) {
            const std::array<double, 3> p = {static_cast<double>(i % 3), 7.0,
                                             static_cast<double>(i / 3)};
            points.push_back({p[static_cast<std::size_t>(axis)],
                              p[static_cast<std::size_t>((axis + 1) % 3)],
                              p[static_cast<std::size_t>((axis + 2) % 3)]});
        }
        const ConvexHull hull = convex_hull(points);
        EXPECT_EQ(hull.dimension, 2);
        EXPECT_EQ(hull.numbers, (Numbers{0, 2, 6, 8}));
        EXPECT_EQ(hull.groups, (Numbers{0, 2, 4}));
        EXPECT_EQ(hull_flaw(points, hull), "");
    }
}

// By hand: a cube has 6 faces of two triangles each.
TEST(ConvexHull, CubeHasSixFaces) {
    const Points points = test::unit_cube().positions;
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.dimension, 3);
    EXPECT_EQ(hull.points.size(), 8U);
    EXPECT_EQ(hull.groups, (Numbers{0, 2, 4, 6, 8, 10, 12}));
    EXPECT_EQ(hull_flaw(points, hull), "");
}

// Oracle: every rule of a hull, exactly. On the coarse grid coincidences are common.
TEST(ConvexHull, AgreesWithExactNumbersOnFineAndCoarsePoints) {
    std::mt19937 random(5);
    std::array<int, 4> of_dimension = {};
    for (int round = 0; round < 600; ++round) {
        std::uniform_int_distribution<int> count(1, 24), grid(0, 1 + round % 3);
        std::uniform_real_distribution<double> fine(-1, 1);
        Points points;
        for (int i = count(random); i > 0; --i) {
            if (round % 4 == 0) {
                points.push_back({fine(random), fine(random), fine(random)});
            } else {
                points.push_back({static_cast<double>(grid(random)),
                                  static_cast<double>(grid(random)),
                                  static_cast<double>(grid(random) / (1 + round % 2))});
            }
        }
        const ConvexHull hull = convex_hull(points);
        ASSERT_EQ(hull_flaw(points, hull), "") << "round " << round;
        ++of_dimension.at(static_cast<std::size_t>(hull.dimension));
    }
    for (const int hulls : of_dimension) EXPECT_GE(hulls, 15);
    EXPECT_GE(of_dimension[3], 180);
    EXPECT_LE(of_dimension[3], 520);
}

}  // namespace
}  // namespace cdprep::convex
