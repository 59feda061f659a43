// SPDX-License-Identifier: MIT
#include "scene_file/deform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/meshes.h"

namespace cdprep::scenes {
namespace {

constexpr double kDeformRounding = 1e-14;

void expect_close(const Double3& found, const Double3& expected) {
    EXPECT_NEAR(found.x, expected.x, kDeformRounding);
    EXPECT_NEAR(found.y, expected.y, kDeformRounding);
    EXPECT_NEAR(found.z, expected.z, kDeformRounding);
}

TEST(RestBox, HoldsItsPoints) {
    const std::vector<Double3> points = {{1, -2, 3}, {-1, 4, 3}, {0, 0, 5}};
    const RestBox box = RestBox::of(points);
    EXPECT_EQ(box.lower, (Double3{-1, -2, 3}));
    EXPECT_EQ(box.upper, (Double3{1, 4, 5}));
    EXPECT_EQ(box.middle(), (Double3{0, 1, 4}));
    EXPECT_EQ(RestBox::of({}).upper, Double3{});
}

// By hand: a quarter of a period has the amplitude, a half nothing.
TEST(Shear, FollowsASineOrARate) {
    const Shear wave = {.amplitude = 3, .period_s = 4};
    EXPECT_EQ(wave.factor(0), 0);
    EXPECT_NEAR(wave.factor(1), 3, kDeformRounding);
    EXPECT_NEAR(wave.factor(2), 0, kDeformRounding);
    EXPECT_NEAR(wave.factor(3), -3, kDeformRounding);
    EXPECT_NEAR(wave.factor(4e9 + 1), 3, kDeformRounding) << "after a billion periods";
    EXPECT_EQ((Shear{.rate_per_s = 0.5}).factor(3), 1.5);
}

// By hand: the middle of the unit cube is at 0.5.
TEST(Shear, MovesEachVertexByItsHeight) {
    const auto rest = test::unit_cube().positions;
    const RestBox box = RestBox::of(rest);
    std::vector<Double3> moved(rest.size());
    shear({.of = 2, .along = 0}, 3, box, rest, moved);
    for (std::size_t i = 0; i < rest.size(); ++i) {
        EXPECT_EQ(moved[i], (Double3{rest[i].x, rest[i].y, rest[i].z + 3 * (rest[i].x - 0.5)}));
    }
    shear({.of = 2, .along = 0}, 0, box, rest, moved);
    EXPECT_EQ(moved, rest);
}

// By hand: the ends of a box from 0 to 2 along y turn by 45 degrees, one to each side.
TEST(Twist, TurnsTheEndsAgainstEachOther) {
    const std::vector<Double3> rest = {{-1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}, {-1, 2, 0}};
    std::vector<Double3> moved(rest.size());
    const Twist quarter = {.axis = 1, .angle_rad = std::numbers::pi / 2, .period_s = 4};
    EXPECT_NEAR(quarter.angle(1), std::numbers::pi / 2, kDeformRounding);
    twist(quarter, quarter.angle(1), RestBox::of(rest), rest, moved);
    const double h = std::sqrt(0.5);
    // About y, a positive angle leads from z to x. At y = 0 it is -45 degrees.
    expect_close(moved[0], {-h, 0, -h});
    expect_close(moved[1], {h, 0, h});
    expect_close(moved[2], {1, 1, 0});
    expect_close(moved[3], {h, 2, -h});
    expect_close(moved[4], {-h, 2, h});
}

TEST(Twist, KeepsEveryBitWithoutAnAngleOrALength) {
    const auto rest = test::turned(test::icosphere(1), 0.3).positions;
    const auto flat = test::grid_sheet(3, 3).positions;
    std::vector<Double3> moved(rest.size());
    twist({.axis = 0}, 0, RestBox::of(rest), rest, moved);
    EXPECT_EQ(moved, rest);
    moved.resize(flat.size());
    twist({.axis = 2}, 1, RestBox::of(flat), flat, moved);
    EXPECT_EQ(moved, flat);
}

}  // namespace
}  // namespace cdprep::scenes
