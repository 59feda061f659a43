// SPDX-License-Identifier: MIT
#include "cdprep/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "cdprep/placement.h"
#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

constexpr std::array<double, 12> kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

std::string refusal(const Result<Pose>& pose) {
    if (pose) return "accepted";
    EXPECT_EQ(pose.error().code, ErrorCode::bad_argument);
    return pose.error().message;
}

std::string refusal_with(std::size_t index, double number) {
    std::array<double, 12> rows = kIdentity;
    rows[index] = number;
    return refusal(Pose::from_rows(rows));
}

TEST(Pose, KeepsTheNumbersItWasMadeOf) {
    const Result<Pose> pose = Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, 4, 5, 6});
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose.value().rotation(), (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
    EXPECT_EQ(pose.value().translation(), (Double3{4, 5, 6}));
    // A quarter turn about z: x goes to y.
    EXPECT_EQ(moved(pose.value(), {1, 2, 3}), (Double3{2, 6, 9}));
}

TEST(Pose, TheDefaultMovesNothing) {
    EXPECT_EQ(moved(Pose(), {0.1, -2e300, 3e-300}), (Double3{0.1, -2e300, 3e-300}));
}

TEST(Pose, NamesTheNumberThatIsNotFinite) {
    for (std::size_t i = 0; i < 12; ++i) {
        for (const double bad :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
            EXPECT_NE(refusal_with(i, bad).find("Number " + std::to_string(i + 1) + " "),
                      std::string::npos);
        }
    }
}

TEST(Pose, TranslationsEndWhereCoordinatesEnd) {
    EXPECT_EQ(refusal_with(9, format::kMaxCoordinate), "accepted");
    EXPECT_EQ(refusal_with(11, -format::kMaxCoordinate), "accepted");
    EXPECT_NE(refusal_with(10, std::nextafter(format::kMaxCoordinate, 1e308)).find("Number 11"),
              std::string::npos);
}

// |R^T R - I| of a matrix with one diagonal entry 1 + e is 2 e + e^2.
TEST(Pose, RotationsMayBeOffByTheToleranceAndNoMore) {
    EXPECT_EQ(refusal_with(0, 1 + 0.49e-12), "accepted");
    EXPECT_NE(refusal_with(0, 1 + 0.51e-12).find("|R^T R - I|"), std::string::npos);
    EXPECT_NE(refusal_with(0, 1e200).find("|R^T R - I|"), std::string::npos);
    EXPECT_NE(refusal_with(4, 0).find("|R^T R - I|"), std::string::npos);
    EXPECT_NE(refusal_with(1, 2e-12).find("|R^T R - I|"), std::string::npos);
}

TEST(Pose, MirrorsAreRefused) {
    EXPECT_NE(refusal(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 0})).find("mirrors"),
              std::string::npos);
    EXPECT_NE(refusal(Pose::from_rows({0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0})).find("mirrors"),
              std::string::npos);
}

// (1, 0, 0, 1) turns by a quarter about z, whatever its length.
TEST(Pose, TheLengthOfAQuaternionDoesNotMatter) {
    for (const double length : {1.0, 1e-310, 1e-150, 3.7, 1e150, 1e308}) {
        const Result<Pose> pose = Pose::from_quaternion(length, 0, 0, length, {1, 0, 0});
        ASSERT_TRUE(pose) << length;
        const std::array<double, 9> exact = {0, -1, 0, 1, 0, 0, 0, 0, 1};
        for (std::size_t i = 0; i < 9; ++i) {
            EXPECT_NEAR(pose.value().rotation()[i], exact[i], Pose::kQuaternionError) << length;
        }
    }
}

TEST(Pose, QuaternionsWithoutDirectionAreRefused) {
    EXPECT_NE(refusal(Pose::from_quaternion(0, 0, 0, 0, {})).find("zero"), std::string::npos);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal(Pose::from_quaternion(1, 0, nan, 0, {})).find("finite"), std::string::npos);
    EXPECT_NE(refusal(Pose::from_quaternion(1, 0, 0, 0, {0, 1e305, 0})).find("Number 11"),
              std::string::npos);
}

/// How far the entries of R are from those of the exact matrix, worst of nine.
double quaternion_error(double w, double x, double y, double z) {
    const Pose pose = Pose::from_quaternion(w, x, y, z, {}).value();
    const ExactRational ew(w), ex(x), ey(y), ez(z), two(2);
    const ExactRational square = ew * ew + ex * ex + ey * ey + ez * ez;
    const std::array<ExactRational, 9> exact = {ew * ew + ex * ex - ey * ey - ez * ez,
                                                two * (ex * ey - ew * ez),
                                                two * (ex * ez + ew * ey),
                                                two * (ex * ey + ew * ez),
                                                ew * ew - ex * ex + ey * ey - ez * ez,
                                                two * (ey * ez - ew * ex),
                                                two * (ex * ez - ew * ey),
                                                two * (ey * ez + ew * ex),
                                                ew * ew - ex * ex - ey * ey + ez * ez};
    double worst = 0;
    for (std::size_t i = 0; i < 9; ++i) {
        const ExactRational error = exact[i] / square - ExactRational(pose.rotation()[i]);
        worst = std::max(worst, std::fabs(static_cast<double>(error.approximation())));
    }
    return worst;
}

TEST(Pose, QuaternionsBecomeTheMatrixWithinTheStatedError) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        const double w = normal(random), x = normal(random), y = normal(random);
        worst = std::max(worst, quaternion_error(w, x, y, normal(random)));
    }
    EXPECT_LE(worst, Pose::kQuaternionError);
    EXPECT_GT(worst, 0);  // the oracle measures something
}

TEST(RelativePose, OfAPoseToItselfIsTheIdentityUpToRounding) {
    const Pose pose = Pose::from_quaternion(0.3, -0.5, 0.7, 0.1, {10, 20, 30}).value();
    const Pose relative = relative_pose(pose, pose);
    // Two errors of R meet in each of three products, which round too.
    constexpr double kRounding = 6 * Pose::kQuaternionError;
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(relative.rotation()[i], i % 4 == 0 ? 1 : 0, kRounding);
    }
    EXPECT_EQ(relative.translation(), (Double3{0, 0, 0}));
}

// A stands a quarter turn about z from B and one unit along x: by hand.
TEST(RelativePose, TakesPointsOfBIntoTheFrameOfA) {
    const Pose a = Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0}).value();
    const Pose b = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 5}).value();
    EXPECT_EQ(moved(relative_pose(a, b), {2, 3, 4}), (Double3{3, -1, 9}));
}

TEST(Placement, SaysWhoMoves) {
    const Pose pose = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 7, 0, 0}).value();
    EXPECT_FALSE(Placement::b_moves(pose).a_is_moved());
    EXPECT_TRUE(Placement::b_moves(pose).b_is_moved());
    EXPECT_TRUE(Placement::a_moves(pose).a_is_moved());
    EXPECT_FALSE(Placement::a_moves(pose).b_is_moved());
    const Placement world = Placement::world(pose, Pose());
    EXPECT_TRUE(world.a_is_moved() && world.b_is_moved());
    EXPECT_EQ(Placement::relative(pose, Pose()).pose_b().translation(), (Double3{-7, 0, 0}));
}

}  // namespace
}  // namespace cdprep::test
