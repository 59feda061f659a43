// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "support/brute_force.h"
#include "support/exact_distance.h"
#include "support/open_tiny.h"

#include "cdprep/points.h"

namespace cdprep::test {
namespace {

ExactRational exact_nearest(const TestMesh& mesh, const Double3& q) {
    ExactRational best = exact_squared_distance(q, corners_of(mesh, 0, nullptr));
    for (std::size_t i = 1; i < mesh.triangles.size(); ++i) {
        best = std::min(best, exact_squared_distance(q, corners_of(mesh, i, nullptr)));
    }
    return best;
}

/// Interval, triangle and limit, all against exact numbers.
void expect_truth(const TestMesh& mesh, const OpenModel& model, const Double3& q,
                  Workspace& workspace, int round) {
    const ExactRational truth = exact_nearest(mesh, q);
    const auto hit = closest_point(model.model, q, workspace);
    ASSERT_TRUE(hit) << round;
    ASSERT_LE(exact_square(hit->lower), truth) << round;
    ASSERT_GE(exact_square(hit->upper), truth) << round;
    const auto of_triangle = exact_squared_distance(q, corners_of(mesh, hit->triangle, nullptr));
    const double width = hit->upper - hit->lower;
    ASSERT_LE(of_triangle, exact_square(hit->upper + 2 * width + 0x1p-1060)) << round;
    // The limit: nothing within is missed, nothing beyond is found.
    ASSERT_TRUE(closest_point(model.model, q, workspace, hit->upper)) << round;
    if (const double less = hit->lower * (1 - 1e-6); less < hit->lower) {
        ASSERT_FALSE(closest_point(model.model, q, workspace, less)) << round;
    }
}

Double3 draw(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> component(-size, size);
    const double x = component(random), y = component(random), z = component(random);
    return {x, y, z};
}

TEST(ClosestPointLaws, TheIntervalHoldsTheExactDistance) {
    constexpr std::uint32_t kSeed = 51;
    std::mt19937 random(kSeed);
    for (int round = 0; round < 120 && !HasFatalFailure(); ++round) {
        const TestMesh mesh = round % 3 == 0   ? random_soup(random(), 70, 0.3)
                              : round % 3 == 1 ? random_soup(random(), 70, 1e-9)
                                               : coarse_grid_soup(random(), 70, 2);
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        Workspace workspace;
        for (int i = 0; i < 8 && !HasFatalFailure(); ++i) {
            Double3 q = draw(random, i % 2 == 0 ? 2 : 20);
            if (i % 4 < 2) q = {std::round(q.x), std::round(q.y), std::round(q.z)};
            expect_truth(mesh, model, q, workspace, round);
        }
    }
}

TEST(ClosestPointLaws, TheIntervalHoldsTheExactDistanceAtEverySize) {
    constexpr std::uint32_t kSeed = 52;
    std::mt19937 random(kSeed);
    Workspace workspace;
    for (const int exponent : {-1060, -1040, -1000, -500, 300, 900, 990}) {
        const double scale = std::ldexp(1.0, exponent);
        for (int round = 0; round < 6 && !HasFatalFailure(); ++round) {
            const TestMesh mesh = moved_by(
                round % 2 == 0 ? random_soup(random(), 40, 0.5) : coarse_grid_soup(random(), 40, 2),
                scale, {0, 0, 0});
            const OpenModel model = open_tiny(mesh, {.double_precision = true});
            for (int i = 0; i < 4 && !HasFatalFailure(); ++i) {
                const Double3 q = draw(random, 2);
                expect_truth(mesh, model, {scale * q.x, scale * q.y, scale * q.z}, workspace,
                             exponent);
            }
        }
    }
}

// The point may be where the frame's coordinates cannot reach.
TEST(ClosestPointLaws, PointsFarBeyondTheModelAreAnswered) {
    Workspace workspace;
    const TestMesh mesh = moved_by(unit_cube(), 0x1p-1000, {0, 0, 0});
    const OpenModel model = open_tiny(mesh, {.double_precision = true});
    const auto hit = closest_point(model.model, {1e300, 0, 0}, workspace, 1e301);
    ASSERT_TRUE(hit);
    EXPECT_LE(hit->lower, 1e300);
    EXPECT_GE(hit->upper, 1e300);
}

// Moving the numbers of the triangles moves the answer along.
TEST(ClosestPointLaws, TheLowestNumberAnswersAmongCopies) {
    Workspace workspace;
    const TestMesh copies = copies_of_one_triangle(100);
    const OpenModel model = open_tiny(copies, {.double_precision = true});
    std::mt19937 random(53);
    for (int i = 0; i < 50; ++i) {
        const auto hit = closest_point(model.model, draw(random, 3), workspace);
        ASSERT_TRUE(hit);
        ASSERT_EQ(hit->triangle, 0U) << "seed 53, point " << i;
    }
}

}  // namespace
}  // namespace cdprep::test
