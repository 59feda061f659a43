// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cdprep/advanced/query_counts.h"
#include "cdprep/bounded_distance.h"
#include "cdprep/pairs.h"
#include "support/brute_force_distance.h"
#include "support/hard_distances.h"
#include "support/hard_triangles.h"
#include "support/open_tiny.h"
#include "support/placements.h"
#include "support/random_pose.h"
#include "support/rounds.h"
#include "support/same_distance.h"
#include "support/slanted_panes.h"

#include "exact/triangle_distance.h"

namespace cdprep::test {
namespace {

double largest_coordinate(const TestMesh& a, const TestMesh& b, const Placement& placement) {
    double largest = 0;
    for (const auto* mesh : {&a, &b}) {
        const bool is_moved = mesh == &a ? placement.a_is_moved() : placement.b_is_moved();
        const Pose& pose = !is_moved    ? Pose()
                           : mesh == &a ? placement.pose_a()
                                        : placement.pose_b();
        for (const Double3& p : mesh->positions) {
            const Double3 q = transform_point(pose, p);
            largest = std::max({largest, std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
        }
    }
    return largest;
}

struct Case {
    TestMesh a;
    TestMesh b;
    Placement placement;
};

/// Small soups, fine and coarse, near and far, in every placement.
Case random_case(std::mt19937& random, int round, int triangles = 10) {
    const bool coarse = round % 2 == 0;
    const auto soup = [&] {
        return coarse ? coarse_grid_soup(random(), triangles, 2)
                      : random_soup(random(), triangles, 0.2);
    };
    Case made{soup(), soup(), Placement::b_moves(Pose())};
    const double reach = std::pow(10, static_cast<int>(random() % 4) - 1);
    const Pose p = coarse ? Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, reach, 0.5, 1}).value()
                          : random_pose(random, reach);
    const Pose q = random_pose(random, reach);
    made.placement = placement_of_kind(random(), p, q);
    return made;
}

// The oracle: every pair of triangles in rational arithmetic; squares are compared.
TEST(DistanceLaws, TheIntervalHoldsTheTruthAndIsNarrow) {
    const int kRounds = rounds(10'000, 4);
    std::mt19937 random(20261121);
    int apart = 0;
    for (int round = 0; round < kRounds; ++round) {
        const Case c = random_case(random, round, round % 16 == 0 ? 12 : 3);
        const OpenModel a = open_tiny(c.a, {.double_precision = round % 3 == 0});
        const OpenModel b = open_tiny(c.b);
        Workspace workspace;
        const auto found = distance({a.model, b.model, c.placement}, workspace);
        ASSERT_TRUE(found);
        const ExactRational truth = brute_force_distance(c.a, c.b, c.placement);
        ASSERT_TRUE(square(found->lower) <= truth) << round << ": " << found->lower;
        ASSERT_TRUE(truth <= square(found->upper)) << round << ": " << found->upper;
        const double largest = largest_coordinate(c.a, c.b, c.placement);
        EXPECT_LE(found->upper - found->lower, 1e-12 * found->lower + 1e-15 * largest) << round;
        const bool touch = truth.sign() == 0;
        EXPECT_EQ(touch, found->upper == 0);
        EXPECT_EQ(touch, collide({a.model, b.model, c.placement}, workspace).hit == Answer::yes);
        const double between = std::hypot(found->witness_b.x - found->witness_a.x,
                                          found->witness_b.y - found->witness_a.y,
                                          found->witness_b.z - found->witness_a.z);
        EXPECT_NEAR(between, found->upper, 1e-12 * found->upper + 1e-14 * largest) << round;
        apart += touch ? 0 : 1;
    }
    EXPECT_GT(apart, kRounds / 2);
    EXPECT_LT(apart, kRounds * 19 / 20);
}

/// A long thin triangle at about this height: rounding is of its length, not of the distance.
TestMesh sliver(std::mt19937& random, double gap) {
    std::uniform_real_distribution<double> fine(-1, 1);
    const double y = fine(random), z = gap + 0.1 * gap * fine(random);
    return {{{-1, -1 + 1e-3 * fine(random), z + gap * 1e-3 * fine(random)},
             {1, 1e-3 * fine(random) + 1, z + gap * 1e-3 * fine(random)},
             {1e-3 * y, 1e-3 * fine(random), z}},
            {{{0, 1, 2}}}};
}

// Two contenders: a sliver, and a plain triangle whose distance is known exactly and lies between
// the sliver's truth and its upper bound. The plain one answers; the lower bound is the sliver's.
TEST(DistanceLaws, TheLowerBoundIsTheLeastOfAllContenders) {
    std::mt19937 random(20261122);
    int different = 0, decisive = 0;
    for (int round = 0; round < 2000; ++round) {
        TestMesh a = sliver(random, 0), b = sliver(random, 0x1p-5);
        for (Double3& p : b.positions) p.x = -p.x;
        const Corners sliver_a = corners_of(a, 0, nullptr), sliver_b = corners_of(b, 0, nullptr);
        const TriangleDistance wide = triangle_distance(sliver_a, sliver_b, true);
        const ExactRational truth = exact_squared_distance(sliver_a, sliver_b);
        const auto near = static_cast<double>(std::sqrt(truth.approximation()));
        const double height = near + (wide.upper - near) / 2;
        if (!(truth < square(height)) || !(height < wide.upper)) continue;
        a = joined(a, {{{4, 0, 0}, {4 + 0x1p-5, 0, 0}, {4, 0x1p-5, 0}}, {{{0, 1, 2}}}});
        b = joined(b, {{{4 + 0x1p-7, 0x1p-7, height}, {4 + 0x1p-5, 0, 0x1p-4}, {4, 0x1p-5, 0x1p-4}},
                       {{{0, 1, 2}}}});
        const TriangleDistance plain =
            triangle_distance(corners_of(a, 1, nullptr), corners_of(b, 1, nullptr), true);
        const OpenModel model_a = open_tiny(a, {.double_precision = true});
        const OpenModel model_b = open_tiny(b, {.double_precision = true});
        Workspace workspace;
        const auto found =
            distance({model_a.model, model_b.model, Placement::b_moves(Pose())}, workspace);
        ASSERT_TRUE(found);
        ASSERT_TRUE(square(found->lower) <= truth) << round;
        ASSERT_TRUE(truth <= square(found->upper)) << round;
        if (!(wide.lower < plain.lower && plain.upper < wide.upper)) continue;
        ++different;
        EXPECT_EQ(found->triangle_a, 1U) << round;
        decisive += truth < square(plain.lower) ? 1 : 0;
    }
    EXPECT_GT(different, 500);
    EXPECT_GT(decisive, 200);
}

TEST(DistanceLaws, PermittedErrorsAreKept) {
    std::mt19937 random(2);
    for (int round = 0; round < 200; ++round) {
        const Case c = random_case(random, round);
        const OpenModel a = open_tiny(c.a), b = open_tiny(c.b);
        Workspace workspace;
        const auto best = distance({a.model, b.model, c.placement}, workspace);
        for (const double error : {1e-6, 1e-3, 0.1, 1.0}) {
            const auto by_ratio =
                distance({a.model, b.model, c.placement}, workspace, {.relative_error = error});
            const auto by_length =
                distance({a.model, b.model, c.placement}, workspace, {.absolute_error = error});
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

// By hand: one pane is 0.95 above the plate. Another is 1 above it, up to rounding, and may be
// measured first. The limit between them is 1.
TEST(DistanceLaws, PermittedErrorsKeepWhatIsWithinTheLimit) {
    const OpenModel plate = open_slanted(slanted_plate());
    Workspace workspace;
    for (int k = 0; k < 40; ++k) {
        const OpenModel panes = open_slanted(slanted_panes(1 + k * 2.5e-13, 0.95));
        const Pair pair{plate.model, panes.model, Placement::b_moves(Pose())};
        for (const DistanceOptions& options :
             {DistanceOptions{.max_distance = 1},
              DistanceOptions{.relative_error = 0.0625, .max_distance = 1},
              DistanceOptions{.absolute_error = 0.1, .max_distance = 1}}) {
            const auto found = distance(pair, workspace, options);
            ASSERT_TRUE(found) << k;
            EXPECT_LE(found->lower, 0.9500001);
            EXPECT_GE(found->upper, 0.9499999);
            EXPECT_LE(found->upper, 1);
            const BoundedDistance bounded = bounded_distance(pair, workspace, options);
            EXPECT_TRUE(bounded.is_complete);
            EXPECT_TRUE(bounded.nearest) << k;
            EXPECT_LE(bounded.lower, 0.9500001);
        }
    }
}

/// A triangle parallel to slanted_plate(), at this height above its plane.
TestMesh pane_at(double along, double place, double height) {
    const double up = height * std::sqrt(0.5);
    const double x = along - up, z = along + up;
    return {{{x, place, z}, {x, place + 1, z}, {x + 1, place, z + 1}}, {{{0, 1, 2}}}};
}

// Two panes are as far away as the limit, up to rounding. The interval of the first is wider. Where
// its true distance is within the limit, the upper bound of the second may be less, but exceed it.
TEST(DistanceLaws, NothingIsFoundOnlyWhereNothingIsWithin) {
    const OpenModel plates =
        open_slanted(joined(moved_by(slanted_plate(), 0.2, {0, -300, 0}), slanted_plate()));
    std::mt19937 random(20261128);
    std::uniform_real_distribution<double> fine(-4e-13, 4e-13);
    Workspace workspace;
    int near = 0, far = 0;
    for (int round = 0; round < 2000; ++round) {
        const OpenModel panes = open_slanted(
            joined(pane_at(60, -240, 1 + fine(random)), pane_at(300, 300, 1 + fine(random))));
        const Pair pair{plates.model, panes.model, Placement::b_moves(Pose())};
        const bool is_near = within(pair, 1, workspace);
        const auto found = distance(pair, workspace, {.max_distance = 1});
        EXPECT_TRUE(found || !is_near) << round;
        EXPECT_EQ(bounded_distance(pair, workspace, {.max_distance = 1}).nearest.has_value(),
                  found.has_value());
        (is_near ? near : far) += 1;
    }
    EXPECT_GT(near, 400);
    EXPECT_GT(far, 400);
}

// By definition: such an error permits nothing, so the answer is that without an error.
TEST(DistanceLaws, ErrorsThatAreNoLengthsCountAsZero) {
    const OpenModel plate = open_slanted(slanted_plate());
    const OpenModel panes = open_slanted(slanted_panes(2, 0.5));
    const Pair pair{plate.model, panes.model, Placement::b_moves(Pose())};
    Workspace workspace;
    const auto expected = distance(pair, workspace);
    ASSERT_TRUE(expected);
    for (const double error : {std::nan(""), -0.5, -1.0, -2.0, -1e308}) {
        for (const DistanceOptions& options :
             {DistanceOptions{.relative_error = error}, DistanceOptions{.absolute_error = error},
              DistanceOptions{.relative_error = error, .absolute_error = error}}) {
            expect_same(distance(pair, workspace, options), expected);
            expect_same(bounded_distance(pair, workspace, options).nearest, expected);
        }
    }
}

// X08: whatever is permitted is used to look at less, never at more.
TEST(DistanceLaws, PermittedErrorsSaveWork) {
    const OpenModel ball = open_tiny(icosphere(4));
    const Placement aside =
        Placement::b_moves(Pose::from_quaternion(5, 1, 2, 3, {2.3, 0.2, 0.1}).value());
    Workspace workspace;
    const auto boxes = [&](const DistanceOptions& options) {
        QueryCounts counts;
        workspace.count_into(&counts);
        const auto found = distance({ball.model, ball.model, aside}, workspace, options);
        workspace.count_into(nullptr);
        EXPECT_TRUE(found);
        return counts.box_pairs;
    };
    std::uint64_t by_ratio = boxes({}), by_length = by_ratio;
    const std::uint64_t all = by_ratio;
    for (const double error : {1e-6, 1e-3, 0.1, 1.0}) {
        const std::uint64_t ratio = boxes({.relative_error = error});
        const std::uint64_t length = boxes({.absolute_error = error});
        EXPECT_LE(ratio, by_ratio) << error;
        EXPECT_LE(length, by_length) << error;
        by_ratio = ratio;
        by_length = length;
    }
    EXPECT_LT(by_ratio, all);
    EXPECT_LT(by_length, all);
}

TEST(DistanceLaws, WithinAgreesWithTheDistance) {
    std::mt19937 random(3);
    int apart = 0;
    for (int round = 0; round < 300; ++round) {
        const Case c = random_case(random, round);
        const OpenModel a = open_tiny(c.a), b = open_tiny(c.b);
        Workspace workspace;
        const auto found = distance({a.model, b.model, c.placement}, workspace);
        // The oracle: all pairs in rational numbers.
        const ExactRational truth = brute_force_distance(c.a, c.b, c.placement);
        ASSERT_TRUE(square(found->lower) <= truth && truth <= square(found->upper)) << round;
        EXPECT_EQ(found->lower > 0, truth.sign() != 0) << round;
        const auto near_enough = [&](double d) {
            return within({a.model, b.model, c.placement}, d, workspace);
        };
        EXPECT_TRUE(near_enough(found->upper)) << round;
        EXPECT_TRUE(near_enough(2 * found->upper + 1e-9));
        EXPECT_EQ(near_enough(0), found->upper == 0);
        EXPECT_FALSE(near_enough(-1));
        EXPECT_FALSE(near_enough(std::nan("")));
        if (found->lower > 0) {
            ++apart;
            EXPECT_FALSE(near_enough(found->lower * (1 - 1e-9)));
        }
        const auto none = distance({a.model, b.model, c.placement}, workspace,
                                   {.max_distance = found->lower * 0.999});
        EXPECT_EQ(none.has_value(), found->upper == 0);
        EXPECT_TRUE(
            distance({a.model, b.model, c.placement}, workspace, {.max_distance = found->upper}));
    }
    EXPECT_GT(apart, 100);
    EXPECT_LT(apart, 290);
}

// X07: the tolerance belongs to it. All numbers are dyadic, so the truth is known.
TEST(DistanceLaws, ATolerancesOwnDistanceCounts) {
    const OpenModel cube = open_tiny(unit_cube());
    Workspace workspace;
    for (const double gap : {1.0, 0.5, 0x1p-10, 0x1p-30, 3 * 0x1p-20}) {
        const Placement placement = Placement::b_moves(
            Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 1 + gap, 0.25, 0.125}).value());
        EXPECT_TRUE(within({cube.model, cube.model, placement}, gap, workspace)) << gap;
        EXPECT_FALSE(
            within({cube.model, cube.model, placement}, std::nextafter(gap, 0.0), workspace));
        const auto found = distance({cube.model, cube.model, placement}, workspace);
        EXPECT_NEAR(found->upper, gap, 1e-14);
    }
}

// The oracle: squares in rational numbers. Soups on a grid have distances that double
// holds to the last bit, where one step less must be too little; others it does not.
TEST(DistanceLaws, ToleranceIsDecidedToTheLastBit) {
    constexpr std::uint32_t kSeed = 345;
    std::mt19937 random(kSeed);
    int hits = 0, asked = 0, ties = 0;
    for (int round = 0; round < 1500; ++round) {
        const TestMesh a = coarse_grid_soup(random(), 3, 2), b = coarse_grid_soup(random(), 3, 2);
        const auto step = [&random] { return static_cast<double>(random() % 13) - 6; };
        const Placement placement = Placement::b_moves(
            Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, step(), step(), step()}).value());
        const ExactRational truth = brute_force_distance(a, b, placement);
        const auto near = static_cast<double>(std::sqrt(truth.approximation()));
        const OpenModel model_a = open_tiny(a), model_b = open_tiny(b);
        Workspace workspace;
        ties += square(near) == truth && near > 0 ? 1 : 0;
        for (const double tolerance :
             {near, std::nextafter(near, 0.0), std::nextafter(near, 99.0)}) {
            const bool expected = truth <= square(tolerance);
            ASSERT_EQ(within({model_a.model, model_b.model, placement}, tolerance, workspace),
                      expected)
                << "seed " << kSeed << ", round " << round << ", tolerance " << tolerance;
            hits += expected ? 1 : 0;
            ++asked;
        }
    }
    EXPECT_GT(ties, 100);
    EXPECT_GT(hits, asked * 3 / 10);
    EXPECT_LT(hits, asked * 7 / 10);
}

// X01: parallel faces a gap apart, both in one turned pose: the faces' vertices are
// rounded, so the truth is that of the rounded ones.
TEST(DistanceLaws, ParallelFacesKeepTheirGapWhenTurned) {
    const TestMesh cube = unit_cube();
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {0.5, -0.25, 2}).value();
    for (const double gap : {0x1p-3, 0x1p-20, 0x1p-40, 1e-12}) {
        const TestMesh beside = cube_beside(gap);
        const OpenModel a = open_tiny(cube, {.double_precision = true});
        const OpenModel b = open_tiny(beside, {.double_precision = true});
        Workspace workspace;
        const auto still = distance({a.model, b.model, Placement::b_moves(Pose())}, workspace);
        const ExactRational exact_gap = square(beside.positions[0].x - 1);
        EXPECT_TRUE(square(still->lower) <= exact_gap && exact_gap <= square(still->upper)) << gap;
        const Placement turned = Placement::world(pose, pose);
        const auto found = distance({a.model, b.model, turned}, workspace);
        const ExactRational truth = brute_force_distance(cube, beside, turned);
        EXPECT_TRUE(square(found->lower) <= truth && truth <= square(found->upper)) << gap;
        EXPECT_NEAR(found->upper, gap, 1e-14) << gap;
    }
}

// X04: the catalogue's touching pairs are 0 apart, and by one step, what exact
// arithmetic says.
TEST(DistanceLaws, TouchingIsZeroAndOneStepIsNot) {
    int touching = 0, apart = 0;
    for (const HardPair& pair : hard_triangles()) {
        const TestMesh a{{pair.a[0], pair.a[1], pair.a[2]}, {{{0, 1, 2}}}};
        for (const double step : {0.0, 0x1p-20, -0x1p-20}) {
            TestMesh b{{pair.b[0], pair.b[1], pair.b[2]}, {{{0, 1, 2}}}};
            for (Double3& p : b.positions) p = {p.x + step, p.y + step, p.z + step};
            const OpenModel model_a = open_tiny(a, {.double_precision = true});
            const OpenModel model_b = open_tiny(b, {.double_precision = true});
            const Placement still = Placement::b_moves(Pose());
            Workspace workspace;
            const auto found = distance({model_a.model, model_b.model, still}, workspace);
            const ExactRational truth = brute_force_distance(a, b, still);
            EXPECT_TRUE(square(found->lower) <= truth && truth <= square(found->upper)) << pair.id;
            EXPECT_EQ(found->upper == 0, truth.sign() == 0) << pair.id;
            EXPECT_LE(found->upper - found->lower, 1e-12 * found->lower + 4e-15) << pair.id;
            ++(truth.sign() == 0 ? touching : apart);
        }
    }
    EXPECT_GT(touching, 50);
    EXPECT_GT(apart, 50);
}

// X06: a gap of 1e-12 where a coordinate's last bit is 1e-10: what is stored counts.
TEST(DistanceLaws, CancellationLeavesTheTruthInside) {
    for (const double gap : {1e-12, 1e-10, 3e-10, 1e-6}) {
        const TestMesh a = moved_by(unit_cube(), 1, {1e6, 1e6, 1e6});
        const TestMesh b = moved_by(unit_cube(), 1, {1e6 + 1 + gap, 1e6 + 0.25, 1e6 + 0.125});
        const OpenModel model_a = open_tiny(a, {.double_precision = true});
        const OpenModel model_b = open_tiny(b, {.double_precision = true});
        Workspace workspace;
        for (const Placement& placement :
             {Placement::b_moves(Pose()),
              Placement::b_moves(
                  Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, gap, 0, 0}).value())}) {
            const auto found = distance({model_a.model, model_b.model, placement}, workspace);
            const ExactRational truth = brute_force_distance(a, b, placement);
            EXPECT_TRUE(square(found->lower) <= truth && truth <= square(found->upper)) << gap;
            EXPECT_LE(found->upper - found->lower, 1e-12 * found->lower + 1e-9) << gap;
        }
    }
}

// X09: by hand, a cube of side 1 in the middle of one of side 3.
TEST(DistanceLaws, ASolidInsideAnotherIsNotApart) {
    const OpenModel small = open_tiny(unit_cube());
    const OpenModel large = open_tiny(moved_by(unit_cube(), 3, {-1, -1, -1}));
    Workspace workspace;
    const Placement still = Placement::b_moves(Pose());
    for (const bool swapped : {false, true}) {
        const Model& a = swapped ? large.model : small.model;
        const Model& b = swapped ? small.model : large.model;
        const auto surfaces = distance({a, b, still}, workspace);
        EXPECT_NEAR(surfaces->lower, 1, 1e-12);
        const auto solids =
            distance({a, b, still, {.body = Body::solid}}, workspace, {.max_distance = 0.5});
        ASSERT_TRUE(solids);
        EXPECT_EQ(solids->lower, 0);
        EXPECT_EQ(solids->upper, 0);
        EXPECT_EQ(solids->witness_a, surfaces->witness_a);
        const Placement aside =
            Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 7, 0, 0}).value());
        EXPECT_GT(distance({a, b, aside, {.body = Body::solid}}, workspace)->lower, 1);
    }
}

// X05: over each other, all numbers are dyadic and many pairs equally near; of four tips over
// a plate each is as near as the others. By rationals: whoever answers is as near as any, and the
// same answers again, with a cache too.
TEST(DistanceLaws, EqualMinimaHaveOneWitness) {
    const TestMesh tips = four_tips();
    const TestMesh plate = moved_by(unit_cube(), 8, {-2, -2, -8});
    std::mt19937 random(51);
    const Placement above =
        Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 3}).value());
    for (int round = 0; round < 20; ++round) {
        TestMesh a = round % 2 == 0 ? unit_cube() : plate;
        TestMesh b = round % 2 == 0 ? unit_cube() : tips;
        std::shuffle(a.triangles.begin(), a.triangles.end(), random);
        std::shuffle(b.triangles.begin(), b.triangles.end(), random);
        const double gap = round % 2 == 0 ? 2 : 3;
        ASSERT_TRUE(brute_force_distance(a, b, above) == square(gap));
        const OpenModel model_a = open_tiny(a), model_b = open_tiny(b);
        Workspace workspace;
        PairCache cache;
        const auto first = distance({model_a.model, model_b.model, above}, workspace);
        EXPECT_TRUE(exact_squared_distance(corners_of(a, first->triangle_a, nullptr),
                                           corners_of(b, first->triangle_b, &above.pose_b())) ==
                    square(gap));
        EXPECT_LE(first->lower, gap);
        EXPECT_GE(first->upper, gap);
        EXPECT_LE(first->upper - first->lower, 1e-12 * gap + 1e-15 * 8);
        for (int i = 0; i < 3; ++i) {
            const auto again =
                distance({model_a.model, model_b.model, above, {}, &cache}, workspace);
            EXPECT_EQ(again->triangle_a, first->triangle_a);
            EXPECT_EQ(again->triangle_b, first->triangle_b);
            EXPECT_EQ(again->upper, first->upper);
        }
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
        const auto plain = distance({a.model, b.model, placement}, workspace);
        const auto cached = distance({a.model, b.model, placement, {}, &cache}, workspace);
        ASSERT_EQ(plain->upper, cached->upper) << round;
        ASSERT_EQ(plain->lower, cached->lower) << round;
        ASSERT_EQ(plain->triangle_a, cached->triangle_a) << round;
        ASSERT_EQ(within({a.model, b.model, placement}, 0.5, workspace),
                  within({a.model, b.model, placement, {}, &hits}, 0.5, workspace));
    }
}

TEST(DistanceLaws, NothingIsFarFromAnEmptyModel) {
    const OpenModel empty = open_tiny(TestMesh{}), cube = open_tiny(unit_cube());
    Workspace workspace;
    const Placement still = Placement::b_moves(Pose());
    EXPECT_FALSE(distance({empty.model, cube.model, still}, workspace));
    EXPECT_FALSE(distance({cube.model, empty.model, still}, workspace));
    EXPECT_FALSE(within({empty.model, empty.model, still}, 1e300, workspace));
}

TEST(DistanceLaws, SizeDoesNotMatter) {
    Workspace workspace;
    for (const double size : {0x1p-900, 0x1p-100, 1.0, 0x1p100, 0x1p900}) {
        const OpenModel a = open_tiny(moved_by(icosphere(2), size, {}), {.double_precision = true});
        const Placement placement = Placement::b_moves(
            Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 3 * size, 0, 0}).value());
        const auto found = distance({a.model, a.model, placement}, workspace);
        ASSERT_TRUE(found) << size;
        EXPECT_NEAR(found->upper / size, 1, 0.02) << size;
    }
}

// By hand: points so far apart that float could not hold the square of how far, against
// their size.
TEST(DistanceLaws, NothingIsTooFarToMeasure) {
    const OpenModel dot = open_tiny(TestMesh{{{0, 0, 0}}, {{{0, 0, 0}}}});
    const OpenModel cube = open_tiny(unit_cube());
    Workspace workspace;
    for (const double far : {0x1p40, 0x1p62, 0x1p64, 0x1p66, 0x1p100, 0x1p130, 0x1p900}) {
        const Placement placement =
            Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, far, 0, 0}).value());
        for (const OpenModel* model : {&dot, &cube}) {
            const auto found = distance({model->model, model->model, placement}, workspace);
            ASSERT_TRUE(found) << far;
            EXPECT_NEAR(found->upper / far, 1, 1e-10) << far;
            EXPECT_TRUE(within({model->model, model->model, placement}, far, workspace)) << far;
            EXPECT_FALSE(within({model->model, model->model, placement}, far / 2, workspace));
        }
        EXPECT_FALSE(
            within({dot.model, dot.model, placement}, std::nextafter(far, 0.0), workspace));
    }
}

}  // namespace
}  // namespace cdprep::test
