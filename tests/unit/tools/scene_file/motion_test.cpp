// SPDX-License-Identifier: MIT
#include "scene_file/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random_pose.h"

namespace cdprep::scenes {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-14;

Pose turned_about_z(double angle, const Double3& translation = {}) {
    return *Pose::from_quaternion(std::cos(angle / 2), 0, 0, std::sin(angle / 2), translation);
}

void expect_near(const Result<Pose>& found, const Pose& expected) {
    ASSERT_TRUE(found);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(found->rotation()[i], expected.rotation()[i], kRounding) << i;
    }
    EXPECT_NEAR(found->translation().x, expected.translation().x, kRounding);
    EXPECT_NEAR(found->translation().y, expected.translation().y, kRounding);
    EXPECT_NEAR(found->translation().z, expected.translation().z, kRounding);
}

void expect_equal(const Result<Pose>& found, const Pose& expected) {
    ASSERT_TRUE(found);
    EXPECT_EQ(found->rotation(), expected.rotation());
    EXPECT_EQ(found->translation(), expected.translation());
}

// By hand: a third of a turn by 90 degrees is one by 30 degrees.
TEST(Motion, InterpolatesBetweenKeys) {
    const Motion path =
        Motion::path({{1, turned_about_z(0, {1, 2, 3})}, {4, turned_about_z(kPi / 2, {4, 2, 0})}});
    EXPECT_TRUE(path.moves());
    expect_near(path.at(2, {0, 0, 10}), turned_about_z(kPi / 6, {2, 2, 12}));
}

TEST(Motion, TurnsTheShorterWay) {
    const Motion path =
        Motion::path({{0, turned_about_z(-0.1)}, {1, turned_about_z(2 * kPi - 0.3)}});
    expect_near(path.at(0.5, {}), turned_about_z(-0.2));
}

TEST(Motion, StaysBeforeTheFirstKeyAndAfterTheLast) {
    const Pose first = turned_about_z(1, {1, 0, 0}), last = turned_about_z(2, {2, 0, 0});
    const Motion path = Motion::path({{1, first}, {2, last}});
    expect_equal(path.at(0, {}), first);
    expect_equal(path.at(3, {}), last);
}

// Keys are poses that the file gives: no bit of them may change.
TEST(Motion, PassesThroughKeysExactly) {
    std::mt19937 random(7);
    std::vector<KeyPose> keys;
    for (int i = 0; i < 20; ++i) keys.push_back({0.1 * i, test::random_pose(random, 5)});
    const Motion path = Motion::path(keys);
    for (const KeyPose& key : keys) expect_equal(path.at(key.time_s, {}), key.pose);
}

TEST(Motion, AFixedObjectStays) {
    const Pose pose = turned_about_z(1, {1, 2, 3});
    EXPECT_FALSE(Motion::fixed(pose).moves());
    expect_equal(Motion::fixed(pose).at(100, {}), pose);
}

TEST(Motion, MovesAndTurnsSteadily) {
    const Motion motion = Motion::steady(turned_about_z(0.5, {1, 0, 0}), {0, 2, 0}, {0, 0, 3});
    EXPECT_TRUE(motion.moves());
    expect_equal(motion.at(0, {}), turned_about_z(0.5, {1, 0, 0}));
    expect_near(motion.at(0.25, {0, 0, 1}), turned_about_z(1.25, {1, 0.5, 1}));
    EXPECT_FALSE(Motion::steady({}, {}, {}).moves());
}

// The poses of a scene stay rigid through many turns.
TEST(Motion, StaysRigid) {
    std::mt19937 random(8);
    for (int round = 0; round < 200; ++round) {
        const Motion path =
            Motion::path({{0, test::random_pose(random, 5)}, {1, test::random_pose(random, 5)}});
        const Motion turn = Motion::steady(test::random_pose(random, 5), {1, 2, 3}, {4, -5, 6});
        for (const double time : {1e-9, 0.3, 0.9999, 1e3, 1e6}) {
            EXPECT_TRUE(path.at(time, {}));
            EXPECT_TRUE(turn.at(time, {}));
        }
    }
}

TEST(Motion, RefusesPlacesBeyondTheCoordinates) {
    const Motion motion = Motion::steady({}, {1e300, 0, 0}, {});
    EXPECT_TRUE(motion.at(1, {}));
    const Result<Pose> far = motion.at(100, {});
    ASSERT_FALSE(far);
    EXPECT_EQ(far.error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace cdprep::scenes
