// SPDX-License-Identifier: MIT
#include "cdprep/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "support/random_pose.h"

namespace cdprep::test {
namespace {

constexpr double kPi = std::numbers::pi;

Pose turned_about_z(double angle, const Double3& translation) {
    return Pose::from_quaternion(std::cos(angle / 2), 0, 0, std::sin(angle / 2), translation)
        .value();
}

double gap_between(const Double3& a, const Double3& b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// The largest entry of |R^T R - I|.
double rotation_error(const Pose& pose) {
    const auto& r = pose.rotation();
    double worst = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double sum = r[i] * r[j] + r[3 + i] * r[3 + j] + r[6 + i] * r[6 + j];
            worst = std::max(worst, std::fabs(sum - (i == j ? 1 : 0)));
        }
    }
    return worst;
}

TEST(Motion, StaysWhereItIs) {
    const Pose pose = turned_about_z(1, {1, 2, 3});
    for (const double time : {0.0, 0.25, 1.0}) {
        EXPECT_EQ(Motion(pose).at(time).translation(), pose.translation());
        EXPECT_LE(gap_between(transform_point(Motion(pose).at(time), {4, 5, 6}),
                              transform_point(pose, {4, 5, 6})),
                  1e-14);
    }
}

TEST(Motion, BeginsAndEndsAtTheGivenPosesBitForBit) {
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const Pose start = random_pose(random, 10), end = random_pose(random, 10);
        const Motion motion = Motion::between(start, end, fine_point(random, 3)).value();
        for (const double time : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
            EXPECT_EQ(motion.at(time).rotation(), start.rotation());
            EXPECT_EQ(motion.at(time).translation(), start.translation());
        }
        for (const double time : {1.0, 2.0, std::numeric_limits<double>::infinity()}) {
            EXPECT_EQ(motion.at(time).rotation(), end.rotation());
            EXPECT_EQ(motion.at(time).translation(), end.translation());
        }
    }
}

TEST(Motion, HasNoJumpAtItsEnds) {
    std::mt19937 random(2);
    for (int i = 0; i < 200; ++i) {
        const Pose start = random_pose(random, 10), end = random_pose(random, 10);
        const Motion motion = Motion::between(start, end, fine_point(random, 3)).value();
        const Double3 p = fine_point(random, 3);
        EXPECT_LE(gap_between(transform_point(motion.at(1e-300), p), transform_point(start, p)),
                  1e-13);
        EXPECT_LE(gap_between(transform_point(motion.at(1 - 0x1p-53), p), transform_point(end, p)),
                  1e-13);
        EXPECT_LE(rotation_error(motion.at(0.3)), 1e-14);
    }
}

TEST(Motion, MovesTheCentreStraightAndTurnsEvenly) {
    const Double3 centre = {1, 1, 0};
    const Motion motion =
        Motion::between(turned_about_z(0, {}), turned_about_z(kPi / 2, {4, 0, 0}), centre).value();
    // The centre goes from (1, 1, 0) to (3, 1, 0).
    EXPECT_LE(gap_between(transform_point(motion.at(0.5), centre), {2, 1, 0}), 1e-15);
    const double half = std::sqrt(0.5);
    EXPECT_LE(gap_between(transform_point(motion.at(0.5), {2, 1, 0}), {2 + half, 1 + half, 0}),
              1e-15);
    EXPECT_NEAR(motion.parts().angle, kPi / 2, 1e-15);
}

TEST(Motion, TakesTheShorterWay) {
    for (const double angle : {-3.0, -1e-9, 1e-9, 3.0, 3.3, 6.0}) {
        const Motion motion =
            Motion::between(turned_about_z(0.7, {}), turned_about_z(0.7 + angle, {})).value();
        const double shorter = angle > kPi ? angle - 2 * kPi : angle;
        EXPECT_NEAR(motion.parts().angle, std::fabs(shorter), 1e-15);
        EXPECT_LE(gap_between(motion.parts().axis, {0, 0, shorter < 0 ? -1.0 : 1.0}), 1e-6);
        EXPECT_LE(gap_between(transform_point(motion.at(0.5), {1, 0, 0}),
                              {std::cos(0.7 + shorter / 2), std::sin(0.7 + shorter / 2), 0}),
                  1e-14);
    }
}

TEST(Motion, TurnsByHalfATurn) {
    std::mt19937 random(3);
    for (int i = 0; i < 100; ++i) {
        const Double3 axis = fine_point(random, 1);
        const Pose half = Pose::from_quaternion(0, axis.x, axis.y, axis.z, {}).value();
        const Motion motion = Motion::between(Pose(), half).value();
        EXPECT_NEAR(motion.parts().angle, kPi, 1e-14);
        const Double3 p = fine_point(random, 1);
        EXPECT_LE(gap_between(transform_point(motion.at(1 - 0x1p-53), p), transform_point(half, p)),
                  1e-14);
    }
}

TEST(Motion, FollowsVelocitiesAroundMoreThanOnce) {
    const Motion motion =
        Motion::by_velocity(Pose(), {0, 0, 8}, {0, 0, 4 * kPi}, {1, 0, 0}).value();
    EXPECT_LE(gap_between(transform_point(motion.at(0.125), {2, 0, 0}), {1, 1, 1}), 1e-15);
    EXPECT_LE(gap_between(transform_point(motion.at(0.75), {2, 0, 0}), {0, 0, 6}), 2e-15);
    EXPECT_LE(gap_between(transform_point(motion.at(1), {2, 0, 0}), {2, 0, 8}), 4e-15);
}

TEST(Motion, RejectsWhatIsTooLargeOrNoNumber) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const auto message = [](const Result<Motion>& made) {
        return made ? std::string() : made.error().message;
    };
    EXPECT_EQ(message(Motion::between(Pose(), Pose(), {0, nan, 0})),
              "The centre of the motion is nan; at most 1.0715086071862673e+301 is allowed.");
    EXPECT_EQ(message(Motion::by_velocity(Pose(), {-infinity, infinity, 0}, {})),
              "The shift of the motion is inf; at most 1.0715086071862673e+301 is allowed.");
    EXPECT_EQ(message(Motion::by_velocity(Pose(), {}, {0, 0, 1001})),
              "The turn of the motion is 1001; at most 1000 is allowed.");
    EXPECT_EQ(message(Motion::by_velocity(Pose(), {}, {800, 800, nan})),
              "The turn of the motion is nan; at most 1000 is allowed.");
    EXPECT_EQ(message(Motion::between(Pose(), Pose(), {0x1p999, 0, 0})),
              "The farthest point of the motion is 1.607262910779401e+301; at most "
              "1.0715086071862673e+301 is allowed.");
    EXPECT_TRUE(Motion::between(Pose(), Pose(), {0x1p998, 0, 0}).ok());
}

}  // namespace
}  // namespace cdprep::test
