// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/touched.h"

namespace cdprep::test {
namespace {

// By hand: faces, edges and corners of the box meet the triangle, and just do not.
TEST(TouchingBox, TouchingCounts) {
    const auto hits = [](const Double3& lower, const Double3& upper) {
        return !touched(right_triangle(), Box{lower, upper}).empty();
    };
    EXPECT_TRUE(hits({1, 1, 0}, {2, 2, 1}));  // its face in the triangle's plane
    EXPECT_FALSE(hits({1, 1, 0x1p-1074}, {2, 2, 1}));
    EXPECT_TRUE(hits({2, 2, -1}, {3, 3, 1}));  // an edge across the triangle's edge
    EXPECT_FALSE(hits({std::nextafter(2.0, 3.0), 2, -1}, {3, 3, 1}));
    EXPECT_TRUE(hits({4, 0, 0}, {5, 1, 1}));  // corner to corner
    EXPECT_FALSE(hits({std::nextafter(4.0, 5.0), 0, 0}, {5, 1, 1}));
    EXPECT_TRUE(hits({-1, -1, -1}, {5, 5, 1}));    // around all of it
    EXPECT_TRUE(hits({1, 1, -1}, {1.5, 1.5, 1}));  // pierced by its middle
}

TEST(TouchingBox, FlatBoxesAreRectanglesSegmentsAndPoints) {
    EXPECT_EQ(touched(right_triangle(), Box{{1, 1, 0}, {2, 2, 0}}).size(), 1u);
    EXPECT_EQ(touched(right_triangle(), Box{{1, 1, -1}, {1, 1, 1}}).size(), 1u);
    EXPECT_EQ(touched(right_triangle(), Box{{2, 2, 0}, {2, 2, 0}}).size(), 1u);
    EXPECT_TRUE(touched(right_triangle(), Box{{2, 2, 1}, {3, 3, 1}}).empty());
    EXPECT_TRUE(
        touched(right_triangle(), Box{{2, std::nextafter(2.0, 3.0), 0}, {2, 3, 0}}).empty());
}

TEST(TouchingBox, NoBoxTouchesNothing) {
    const double nan = std::nan("");
    EXPECT_TRUE(touched(unit_cube(), Box{{1, 0, 0}, {0, 1, 1}}).empty());
    EXPECT_TRUE(touched(unit_cube(), Box{{nan, 0, 0}, {1, 1, 1}}).empty());
    EXPECT_TRUE(touched(unit_cube(), Box{{kInfinity, 0, 0}, {kInfinity, 1, 1}}).empty());
    EXPECT_TRUE(touched({}, Box{{0, 0, 0}, {1, 1, 1}}).empty());
}

// By the meaning of a half-space: all of the sheet, and the half that reaches x = 2.5.
TEST(TouchingBox, LimitsMayBeInfinite) {
    const TestMesh sheet = grid_sheet(4, 4);
    const Box all = {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
    EXPECT_EQ(touched(sheet, all), first_numbers(32));
    const Box half = {{2.5, -kInfinity, 0}, {kInfinity, kInfinity, kInfinity}};
    EXPECT_EQ(touched(sheet, half).size(), 16u);
    const Box above = {{-kInfinity, -kInfinity, 0x1p-1000}, {kInfinity, kInfinity, kInfinity}};
    EXPECT_TRUE(touched(sheet, above).empty());
}

// By hand: the cube's x axis becomes the box's z, two further up.
TEST(TouchingBox, AnOrientedBoxIsABoxInItsOwnFrame) {
    const Pose box_from_model = Pose::from_rows({0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 2}).value();
    const ShapeOptions in_box{box_from_model};
    // In the box's frame the cube is [0, 1] x [0, 1] x [2, 3].
    EXPECT_FALSE(touched(unit_cube(), Box{{-1, -1, 1}, {2, 2, 2}}, in_box).empty());
    EXPECT_TRUE(touched(unit_cube(), Box{{-1, -1, 0}, {2, 2, 1.5}}, in_box).empty());
    EXPECT_EQ(touched(unit_cube(), Box{{-1, -1, 2}, {2, 2, 3}}, in_box), first_numbers(12));
    EXPECT_TRUE(touched(unit_cube(), Box{{0.25, 0.25, 2.25}, {0.75, 0.75, 2.75}}, in_box).empty());
}

TEST(TouchingBox, DegenerateTrianglesAnswerAsSegmentsOrNotAtAll) {
    const TestMesh segment{{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}, {{{0, 1, 2}}}};
    const Box around{{0.5, 0.5, 0.5}, {0.75, 0.75, 0.75}};
    EXPECT_EQ(touched(segment, around).size(), 1u);
    EXPECT_TRUE(touched(segment, around, {Pose(), Degenerate::skip}).empty());
    EXPECT_TRUE(touched(segment, Box{{0.5, 0.75, 0}, {0.7, 1, 2}}).empty());
}

}  // namespace
}  // namespace cdprep::test
