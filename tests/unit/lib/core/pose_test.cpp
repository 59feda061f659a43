// SPDX-License-Identifier: MIT
#include "cdprep/pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

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
    EXPECT_EQ(transform_point(pose.value(), {1, 2, 3}), (Double3{2, 6, 9}));
}

TEST(Pose, TheDefaultMovesNothing) {
    EXPECT_EQ(transform_point(Pose(), {0.1, -2e300, 3e-300}), (Double3{0.1, -2e300, 3e-300}));
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
    EXPECT_NE(refusal_with(0, 1 + 0.51e-12).find("scales or shears"), std::string::npos);
    EXPECT_NE(refusal_with(0, 1e200).find("scales or shears"), std::string::npos);
    EXPECT_NE(refusal_with(4, 0).find("scales or shears"), std::string::npos);
    EXPECT_NE(refusal_with(1, 2e-12).find("scales or shears"), std::string::npos);
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
    EXPECT_EQ(transform_point(relative_pose(a, b), {2, 3, 4}), (Double3{3, -1, 9}));
}

// By the tolerance of a pose: errors of two rotations add up, and chains of poses would drift.
TEST(RelativePose, StaysARotation) {
    constexpr double kLonger = 1 + 0x1p-41;
    const Pose longer =
        Pose::from_rows({kLonger, 0, 0, 0, kLonger, 0, 0, 0, kLonger, 0, 0, 0}).value();
    Pose chained = longer;
    for (int i = 0; i < 20; ++i) {
        chained = relative_pose(chained, longer);
        std::array<double, 12> rows{};
        std::copy_n(chained.rotation().begin(), 9, rows.begin());
        EXPECT_TRUE(Pose::from_rows(rows).ok()) << i;
    }
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

using Matrix = std::array<double, 16>;

/// Row by row: R times `scale`, and T.
Matrix matrix_of(const Pose& pose, double scale = 1) {
    const auto& r = pose.rotation();
    const Double3& t = pose.translation();
    return {r[0] * scale,
            r[1] * scale,
            r[2] * scale,
            t.x,
            r[3] * scale,
            r[4] * scale,
            r[5] * scale,
            t.y,
            r[6] * scale,
            r[7] * scale,
            r[8] * scale,
            t.z,
            0,
            0,
            0,
            1};
}

double rotation_error(const Pose& pose) {
    const auto& r = pose.rotation();
    double worst = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double product = r[i] * r[j] + r[3 + i] * r[3 + j] + r[6 + i] * r[6 + j];
            worst = std::max(worst, std::fabs(product - (i == j ? 1.0 : 0.0)));
        }
    }
    return worst;
}

double determinant_of(const Pose& pose) {
    const auto& r = pose.rotation();
    return r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
           r[2] * (r[3] * r[7] - r[4] * r[6]);
}

double farthest_entry(const Pose& a, const Pose& b) {
    double worst = 0;
    for (std::size_t i = 0; i < 9; ++i) {
        worst = std::max(worst, std::fabs(a.rotation()[i] - b.rotation()[i]));
    }
    return worst;
}

// The polar factor of R S is R where S is symmetric and positive: a small stretch along any axes
// does not turn. So the answer is known, up to rounding.
TEST(NearestPose, TakesAStretchOffAndKeepsTheTurn) {
    std::mt19937_64 random(20261122);
    std::uniform_real_distribution<double> share(-1, 1);
    for (int round = 0; round < 2000; ++round) {
        const Pose turn = Pose::from_quaternion(share(random), share(random), share(random),
                                                share(random), {1, 2, 3})
                              .value();
        const Pose axes =
            Pose::from_quaternion(share(random), share(random), share(random), share(random), {})
                .value();
        const double most = round % 2 == 0 ? 1e-6 : 0.03;
        std::array<double, 3> stretch{};
        for (double& s : stretch) s = 1 + most * share(random);
        Matrix m = matrix_of(turn);
        const auto &q = axes.rotation(), &r = turn.rotation();
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                double sum = 0;
                for (std::size_t a = 0; a < 3; ++a) {
                    for (std::size_t k = 0; k < 3; ++k) {
                        sum += r[3 * i + a] * q[3 * a + k] * stretch[k] * q[3 * j + k];
                    }
                }
                m[4 * i + j] = sum;
            }
        }
        const auto nearest = nearest_pose(m, 0.2);
        ASSERT_TRUE(nearest) << nearest.error().message;
        EXPECT_LE(rotation_error(nearest.value()), 1e-15);
        EXPECT_GT(determinant_of(nearest.value()), 0.5);
        EXPECT_LE(farthest_entry(nearest.value(), turn), 4e-15) << "round " << round;
        EXPECT_EQ(nearest.value().translation(), turn.translation());
    }
}

// Floats are off by 2^-24: the pose they were rounded from is as near.
TEST(NearestPose, TakesMatricesOfFloats) {
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {0.5, -8, 1}).value();
    Matrix m = matrix_of(pose);
    for (double& number : m) number = static_cast<float>(number);
    const auto nearest = nearest_pose(m, 1e-6);
    ASSERT_TRUE(nearest);
    EXPECT_LE(rotation_error(nearest.value()), 1e-15);
    EXPECT_LE(farthest_entry(nearest.value(), pose), 1e-7);
    EXPECT_FALSE(nearest_pose(m, 1e-12)) << "floats are not as near as that";
}

TEST(NearestPose, KeepsWhatIsRigidAndReadsBothLayouts) {
    EXPECT_EQ(nearest_pose(matrix_of(Pose()), 0).value().rotation(), Pose().rotation());
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {0.5, -8, 1}).value();
    const Matrix rows = matrix_of(pose);
    Matrix columns{};
    for (std::size_t i = 0; i < 16; ++i) columns[4 * (i % 4) + i / 4] = rows[i];
    const auto a = nearest_pose(rows, 1e-9);
    const auto b = nearest_pose(columns, 1e-9, MatrixLayout::columns);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a.value().rotation(), b.value().rotation());
    EXPECT_EQ(b.value().translation(), pose.translation());
}

// Each changes one thing of a rotation by more than the tolerance, and the sentence names it.
TEST(NearestPose, SaysWhatIsWrong) {
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {}).value();
    const auto refused = [](const Matrix& m, double tolerance, const char* word) {
        const auto nearest = nearest_pose(m, tolerance);
        ASSERT_FALSE(nearest) << word;
        EXPECT_NE(nearest.error().message.find(word), std::string::npos) << nearest.error().message;
    };
    refused(matrix_of(pose, 1.01), 0.01, "scales");
    refused(matrix_of(pose, 0), 0.25, "scales");
    refused(matrix_of(pose, 1e300), 0.25, "scales");
    Matrix sheared = matrix_of(Pose());
    sheared[1] = 0.01;
    refused(sheared, 0.001, "shears");
    refused({1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 0.25, "mirrors");
    refused(matrix_of(pose, -1), 0.25, "mirrors");
    refused({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 1}, 0.25, "projects");
    refused(matrix_of(pose), -1, "tolerance");
    refused(matrix_of(pose), 0.5, "tolerance");
    Matrix broken = matrix_of(pose);
    broken[7] = std::numeric_limits<double>::quiet_NaN();
    refused(broken, 0.25, "Number 8");
}

// Moving by the composed pose is moving twice, and by the inverse is moving back.
TEST(ComposedPose, MovesAsBothDoAndItsInverseBack) {
    const Pose a = Pose::from_quaternion(1, 2, 3, 4, {0.5, -8, 1}).value();
    const Pose b = Pose::from_quaternion(-2, 1, 1, 3, {4, 0.25, -3}).value();
    const Double3 p = {1, -2, 3};
    const auto both = composed_pose(a, b);
    const auto back = inverse_pose(a);
    ASSERT_TRUE(both && back);
    const Double3 at = transform_point(both.value(), p),
                  twice = transform_point(a, transform_point(b, p));
    EXPECT_NEAR(at.x, twice.x, 1e-14);
    EXPECT_NEAR(at.y, twice.y, 1e-14);
    EXPECT_NEAR(at.z, twice.z, 1e-14);
    const Double3 same = transform_point(back.value(), transform_point(a, p));
    EXPECT_NEAR(same.x, p.x, 1e-14);
    EXPECT_NEAR(same.y, p.y, 1e-14);
    EXPECT_NEAR(same.z, p.z, 1e-14);
    EXPECT_EQ(composed_pose(Pose(), b).value().rotation(), b.rotation());
}

// Each product adds a rounding of 1e-16: without correction a long chain is no pose any more.
TEST(ComposedPose, ChainsOfAnyLengthStayRigid) {
    const Pose step = Pose::from_quaternion(1, 0.1, 0.2, 0.3, {}).value();
    Pose pose;
    for (int i = 0; i < 1'000'000; ++i) {
        const auto next = composed_pose(pose, step);
        ASSERT_TRUE(next) << i;
        pose = next.value();
    }
    EXPECT_LE(rotation_error(pose), 2e-13);
}

TEST(ComposedPose, ATranslationBeyondTheLargestCoordinateIsRefused) {
    const Pose far = Pose::from_quaternion(1, 0, 0, 0, {0x1p1000, 0, 0}).value();
    EXPECT_FALSE(composed_pose(far, far));
    const Pose turned = Pose::from_quaternion(1, 1, 1, 0.5, {0x1p1000, 0x1p1000, 0x1p1000}).value();
    EXPECT_FALSE(inverse_pose(turned));
    EXPECT_TRUE(inverse_pose(far));
}

}  // namespace
}  // namespace cdprep::test
