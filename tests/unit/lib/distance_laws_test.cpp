// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cdprep/collide.h"
#include "cdprep/distance.h"
#include "support/brute_force.h"
#include "support/exact_distance.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

ExactRational square(double x) {
    return {ExactNumber(x) * ExactNumber(x), 1.0};
}

double largest_coordinate(const TestMesh& a, const TestMesh& b, const Placement& placement) {
    double largest = 0;
    for (const auto* mesh : {&a, &b}) {
        const bool is_moved = mesh == &a ? placement.a_is_moved() : placement.b_is_moved();
        const Pose& pose = !is_moved    ? Pose()
                           : mesh == &a ? placement.pose_a()
                                        : placement.pose_b();
        for (const Double3& p : mesh->positions) {
            const Double3 q = moved(pose, p);
            largest = std::max({largest, std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
        }
    }
    return largest;
}

/// The square of the distance of two small meshes, all pairs in rational numbers.
ExactRational brute_force_distance(const TestMesh& a, const TestMesh& b,
                                   const Placement& placement) {
    const Pose* pose_a = placement.a_is_moved() ? &placement.pose_a() : nullptr;
    const Pose* pose_b = placement.b_is_moved() ? &placement.pose_b() : nullptr;
    ExactRational best;
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
        for (std::size_t j = 0; j < b.triangles.size(); ++j) {
            const ExactRational d =
                exact_squared_distance(corners_of(a, i, pose_a), corners_of(b, j, pose_b));
            if (i + j == 0 || d < best) best = d;
        }
    }
    return best;
}

struct Case {
    TestMesh a;
    TestMesh b;
    Placement placement;
};

/// Small soups, fine and coarse, near and far, in every placement.
Case random_case(std::mt19937& random, int round) {
    const bool coarse = round % 2 == 0;
    Case made{coarse ? coarse_grid_soup(random(), 10, 2) : random_soup(random(), 10, 0.2),
              coarse ? coarse_grid_soup(random(), 10, 2) : random_soup(random(), 10, 0.2),
              Placement::b_moves(Pose())};
    const double reach = std::pow(10, static_cast<int>(random() % 4) - 1);
    const Pose p = coarse ? Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, reach, 0.5, 1}).value()
                          : random_pose(random, reach);
    const Pose q = random_pose(random, reach);
    switch (random() % 4) {
        case 0:
            made.placement = Placement::b_moves(p);
            break;
        case 1:
            made.placement = Placement::a_moves(p);
            break;
        case 2:
            made.placement = Placement::relative(p, q);
            break;
        default:
            made.placement = Placement::world(p, q);
    }
    return made;
}

// The oracle: every pair of triangles in rational arithmetic; squares are compared.
TEST(DistanceLaws, TheIntervalHoldsTheTruthAndIsNarrow) {
    std::mt19937 random(20261121);
    int apart = 0;
    for (int round = 0; round < 600; ++round) {
        const Case c = random_case(random, round);
        const OpenModel a = open_tiny(c.a, {.double_precision = round % 3 == 0});
        const OpenModel b = open_tiny(c.b);
        Workspace workspace;
        const auto found = distance(a.model, b.model, c.placement, workspace);
        ASSERT_TRUE(found);
        const ExactRational truth = brute_force_distance(c.a, c.b, c.placement);
        ASSERT_TRUE(square(found->lower) <= truth) << round << ": " << found->lower;
        ASSERT_TRUE(truth <= square(found->upper)) << round << ": " << found->upper;
        const double largest = largest_coordinate(c.a, c.b, c.placement);
        EXPECT_LE(found->upper - found->lower, 1e-12 * found->lower + 1e-15 * largest) << round;
        const bool touch = truth.sign() == 0;
        EXPECT_EQ(touch, found->upper == 0);
        EXPECT_EQ(touch, collide(a.model, b.model, c.placement, workspace).hit);
        const double between = std::hypot(found->witness_b.x - found->witness_a.x,
                                          found->witness_b.y - found->witness_a.y,
                                          found->witness_b.z - found->witness_a.z);
        EXPECT_NEAR(between, found->upper, 1e-12 * found->upper + 1e-14 * largest) << round;
        apart += touch ? 0 : 1;
    }
    EXPECT_GT(apart, 300);
    EXPECT_LT(apart, 590);
}

TEST(DistanceLaws, PermittedErrorsAreKept) {
    std::mt19937 random(2);
    for (int round = 0; round < 200; ++round) {
        const Case c = random_case(random, round);
        const OpenModel a = open_tiny(c.a), b = open_tiny(c.b);
        Workspace workspace;
        const auto best = distance(a.model, b.model, c.placement, workspace);
        for (const double error : {1e-6, 1e-3, 0.1, 1.0}) {
            const auto by_ratio =
                distance(a.model, b.model, c.placement, workspace, {.relative_error = error});
            const auto by_length =
                distance(a.model, b.model, c.placement, workspace, {.absolute_error = error});
            for (const auto& found : {by_ratio, by_length}) {
                ASSERT_TRUE(found);
                EXPECT_LE(found->lower, best->upper);
                EXPECT_GE(found->upper, best->lower);
            }
            EXPECT_LE(by_ratio->upper, by_ratio->lower * (1 + error) + 1e-12);
            EXPECT_LE(by_length->upper, by_length->lower + error + 1e-12);
        }
    }
}

TEST(DistanceLaws, WithinAgreesWithTheDistance) {
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        const Case c = random_case(random, round);
        const OpenModel a = open_tiny(c.a), b = open_tiny(c.b);
        Workspace workspace;
        const auto found = distance(a.model, b.model, c.placement, workspace);
        const auto within = [&](double d) {
            return is_within(a.model, b.model, c.placement, d, workspace);
        };
        EXPECT_TRUE(within(found->upper)) << round;
        EXPECT_TRUE(within(2 * found->upper + 1e-9));
        EXPECT_EQ(within(0), found->upper == 0);
        EXPECT_FALSE(within(-1));
        EXPECT_FALSE(within(std::nan("")));
        if (found->lower > 0) {
            EXPECT_FALSE(within(found->lower * (1 - 1e-9)));
        }
        const auto none = distance(a.model, b.model, c.placement, workspace,
                                   {.max_distance = found->lower * 0.999});
        EXPECT_EQ(none.has_value(), found->upper == 0);
        EXPECT_TRUE(
            distance(a.model, b.model, c.placement, workspace, {.max_distance = found->upper}));
    }
}

// X07: the tolerance belongs to it. All numbers are dyadic, so the truth is known.
TEST(DistanceLaws, ATolerancesOwnDistanceCounts) {
    const OpenModel cube = open_tiny(unit_cube());
    Workspace workspace;
    for (const double gap : {1.0, 0.5, 0x1p-10, 0x1p-30, 3 * 0x1p-20}) {
        const Placement placement = Placement::b_moves(
            Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 1 + gap, 0.25, 0.125}).value());
        EXPECT_TRUE(is_within(cube.model, cube.model, placement, gap, workspace)) << gap;
        EXPECT_FALSE(is_within(cube.model, cube.model, placement,
                               std::nextafter(gap, 0.0) * (1 - 1e-12), workspace));
        const auto found = distance(cube.model, cube.model, placement, workspace);
        EXPECT_NEAR(found->upper, gap, 1e-14);
    }
}

// X05: four equal corners; the lowest numbers answer.
TEST(DistanceLaws, EqualMinimaHaveOneWitness) {
    const OpenModel cube = open_tiny(unit_cube());
    Workspace workspace;
    const Placement above =
        Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 3}).value());
    const auto first = distance(cube.model, cube.model, above, workspace);
    PairCache cache;
    for (int i = 0; i < 3; ++i) {
        const auto again = distance(cube.model, cube.model, above, workspace, {}, &cache);
        EXPECT_EQ(again->triangle_a, first->triangle_a);
        EXPECT_EQ(again->triangle_b, first->triangle_b);
        EXPECT_EQ(again->upper, first->upper);
    }
}

TEST(DistanceLaws, ACacheChangesNoAnswer) {
    std::mt19937 random(5);
    const OpenModel a = open_tiny(icosphere(3)), b = open_tiny(torus(1, 0.25, 20, 10));
    Workspace workspace;
    PairCache cache;
    PairCache hits;
    for (int round = 0; round < 200; ++round) {
        const Placement placement = Placement::b_moves(random_pose(random, 3));
        const auto plain = distance(a.model, b.model, placement, workspace);
        const auto cached = distance(a.model, b.model, placement, workspace, {}, &cache);
        ASSERT_EQ(plain->upper, cached->upper) << round;
        ASSERT_EQ(plain->lower, cached->lower) << round;
        ASSERT_EQ(plain->triangle_a, cached->triangle_a) << round;
        ASSERT_EQ(is_within(a.model, b.model, placement, 0.5, workspace),
                  is_within(a.model, b.model, placement, 0.5, workspace, &hits));
    }
}

TEST(DistanceLaws, NothingIsFarFromAnEmptyModel) {
    const OpenModel empty = open_tiny(TestMesh{}), cube = open_tiny(unit_cube());
    Workspace workspace;
    const Placement still = Placement::b_moves(Pose());
    EXPECT_FALSE(distance(empty.model, cube.model, still, workspace));
    EXPECT_FALSE(distance(cube.model, empty.model, still, workspace));
    EXPECT_FALSE(is_within(empty.model, empty.model, still, 1e300, workspace));
}

TEST(DistanceLaws, SizeDoesNotMatter) {
    Workspace workspace;
    for (const double size : {0x1p-900, 0x1p-100, 1.0, 0x1p100, 0x1p900}) {
        const OpenModel a = open_tiny(moved_by(icosphere(2), size, {}), {.double_precision = true});
        const Placement placement = Placement::b_moves(
            Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 3 * size, 0, 0}).value());
        const auto found = distance(a.model, a.model, placement, workspace);
        ASSERT_TRUE(found) << size;
        EXPECT_NEAR(found->upper / size, 1, 0.02) << size;
    }
}

}  // namespace
}  // namespace cdprep::test
