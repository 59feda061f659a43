// SPDX-License-Identifier: MIT
#include "cdprep/time_of_impact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "motion/moving_body.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/rounds.h"
#include "support/slanted_panes.h"

namespace cdprep::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A body that moves without turning.
Motion shifted(const Double3& by) {
    return Motion::by_velocity(Pose(), by, {}).value();
}
Motion spun(const Double3& turn, const Double3& centre = {}) {
    return Motion::by_velocity(Pose(), {}, turn, centre).value();
}

/// A cuboid with these opposite corners.
TestMesh cuboid(const Double3& lower, const Double3& upper) {
    TestMesh mesh = unit_cube();
    for (Double3& p : mesh.positions) {
        p = {p.x == 0 ? lower.x : upper.x, p.y == 0 ? lower.y : upper.y,
             p.z == 0 ? lower.z : upper.z};
    }
    return mesh;
}

struct Case {
    OpenModel a;
    OpenModel b;
    Motion motion_a = {};
    Motion motion_b = {};

    [[nodiscard]] Impact ask(double tolerance = 0, Body body = Body::surface) const {
        Workspace workspace;
        return time_of_impact({a.model, b.model, motion_a, motion_b, body}, workspace,
                              {.tolerance = tolerance});
    }
    [[nodiscard]] bool touch_at(double time) const {
        Workspace workspace;
        const Placement placement = Placement::world(motion_a.at(time), motion_b.at(time));
        return collide({a.model, b.model, placement}, workspace).hit == Answer::yes;
    }
};

/// Expects a narrow interval around the true time.
void expect_impact(const Case& of, double time, double widest = 1e-11) {
    const Impact impact = of.ask();
    ASSERT_EQ(impact.kind, ImpactKind::touching);
    // The true time is that of real numbers; poses are rounded.
    EXPECT_LE(impact.lower, time + 1e-15);
    EXPECT_GE(impact.upper, time - 1e-15);
    EXPECT_LE(impact.upper - impact.lower, widest);
    EXPECT_TRUE(of.touch_at(impact.upper));
    EXPECT_TRUE(impact.lower == 0 || !of.touch_at(impact.lower * (1 - 0x1p-20)));
}

TEST(TimeOfImpact, OfBoxesThatMeetFaceToFace) {
    const TestMesh box = cuboid({0, 0, 0}, {1, 1, 1});
    expect_impact(
        {open_tiny(box), open_tiny(cuboid({3, 0, 0}, {4, 1, 1})), {}, shifted({-8, 0, 0})}, 0.25);
    // Both move, and one of them across.
    expect_impact({open_tiny(box), open_tiny(cuboid({3, 0, 0}, {4, 1, 1})), shifted({2, 0.5, 0}),
                   shifted({-2, 0, 0.25})},
                  0.5);
}

TEST(TimeOfImpact, OfBoxesThatMeetEdgeToEdge) {
    // The edge x = y = 1 of the first meets the edge x = 3, y = 1 + 1 of the second, moving
    // diagonally: the gap in x closes at the same time as that in y.
    expect_impact({open_tiny(cuboid({0, 0, 0}, {1, 1, 1})),
                   open_tiny(cuboid({3, 2, 0}, {4, 4, 1})),
                   {},
                   shifted({-4, -2, 0})},
                  0.5);
}

TEST(TimeOfImpact, OfATurningNeedleAtAWall) {
    const OpenModel wall = open_tiny(cuboid({0.5, -2, -2}, {1, 2, 2}));
    // The tip is at (0, 1, 0), turns towards +x about z, and reaches x = 1/2 after pi / 6.
    const TestMesh needle = {{{0, 0, 0}, {0, 1, 0}, {0, 0, 0x1p-20}}, {{{0, 1, 2}}}};
    expect_impact({open_tiny(cuboid({0.5, -2, -2}, {1, 2, 2})),
                   open_tiny(needle),
                   {},
                   spun({0, 0, -std::numbers::pi / 2})},
                  1.0 / 3);
    // More than once around, and the wall just out of reach.
    const Case missed = {
        open_tiny(cuboid({1 + 1e-9, -2, -2}, {2, 2, 2})), open_tiny(needle), {}, spun({0, 0, -20})};
    EXPECT_NE(missed.ask().kind, ImpactKind::touching);
    EXPECT_NE(missed.ask().kind, ImpactKind::unfinished);
}

TEST(TimeOfImpact, OfABallAtAPlane) {
    TestMesh ball = icosphere(3);
    double lowest = 0;
    for (const Double3& p : ball.positions) lowest = std::min(lowest, p.z);
    // It comes down at an angle and spins about the vertical, which does not change its height.
    Case falling = {open_tiny(cuboid({-50, -50, -8}, {50, 50, -5})),
                    open_tiny(ball),
                    {},
                    Motion::by_velocity(Pose(), {20, 5, -10}, {0, 0, 3}).value()};
    expect_impact(falling, (5 + lowest) / 10, 1e-9);
}

TEST(TimeOfImpact, GrazingContactsAreFoundAndNearMissesAreNot) {
    const auto passing = [](double gap) {
        const TinyOptions doubles = {.double_precision = true};  // in which the gap is no rounding
        return Case{open_tiny(cuboid({0, 0, 0}, {1, 1, 1}), doubles),
                    open_tiny(cuboid({3, 1 + gap, 0}, {4, 2 + gap, 1}), doubles),
                    {},
                    shifted({-8, 0, 0})};
    };
    expect_impact(passing(0), 0.25);
    for (const double gap : {0x1p-20, 0x1p-30, 0x1p-40}) {
        const Impact impact = passing(gap).ask();
        EXPECT_TRUE(impact.kind == ImpactKind::none || impact.kind == ImpactKind::near) << gap;
        EXPECT_EQ(impact.upper, kInfinity);
    }
    EXPECT_EQ(passing(0x1p-20).ask().kind, ImpactKind::none);
    const Impact near = passing(0.001).ask(0.01);
    EXPECT_EQ(near.kind, ImpactKind::near);
    EXPECT_GE(near.lower, 0.24);
    EXPECT_LE(near.lower, 0.51);
    ASSERT_TRUE(near.nearest.has_value());
    EXPECT_LE(near.nearest->upper, 0.01);
}

// S03 of the catalogue: a small ball at a thin shell, farther in a step than the shell is thick.
TEST(TimeOfImpact, NothingPassesThroughAThinShell) {
    const TestMesh outer = moved_by(icosphere(3), 1, {});
    const TestMesh shell = joined(outer, reversed(moved_by(icosphere(3), 0.999, {})));
    const TestMesh ball = moved_by(icosphere(1), 0.1, {});
    std::mt19937 random(1);
    for (int i = 0; i < 50; ++i) {
        const Double3 d = fine_point(random, 1);
        const double length = std::hypot(d.x, d.y, d.z);
        const Pose start =
            Pose::from_quaternion(1, 0, 0, 0,
                                  {-3 * d.x / length, -3 * d.y / length, -3 * d.z / length})
                .value();
        const Case flight = {
            open_tiny(shell),
            open_tiny(ball),
            {},
            Motion::by_velocity(start, {6 * d.x / length, 6 * d.y / length, 6 * d.z / length},
                                fine_point(random, 3))
                .value()};
        const Impact impact = flight.ask(1e-6);
        ASSERT_EQ(impact.kind, ImpactKind::touching);
        EXPECT_LE((impact.upper - impact.lower) * 6, 1e-6);
        EXPECT_NEAR(impact.lower, (3 - 1.1) / 6, 0.02);
    }
}

// S04: a tiny ball at 500 m/s at one triangle, in steps of 1/60 s.
TEST(TimeOfImpact, OfABulletIsRightToAMillionth) {
    const TestMesh target = {{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{{0, 1, 2}}}};
    const TestMesh bullet = moved_by(icosphere(1), 1e-6, {});
    const double way = 500.0 / 60;
    const Case shot = {
        open_tiny(target),
        open_tiny(bullet),
        {},
        Motion::by_velocity(Pose::from_quaternion(1, 0, 0, 0, {0, 0, 5}).value(), {0, 0, -way}, {})
            .value()};
    double lowest = 0;
    for (const Float3& p : shot.b.model.mesh().positions_f32)
        lowest = std::min(lowest, double{p.z});
    const Impact impact = shot.ask();
    const double time = (5 + lowest) / way;
    ASSERT_EQ(impact.kind, ImpactKind::touching);
    EXPECT_NEAR(impact.lower / time, 1, 1e-6);
    EXPECT_NEAR(impact.upper / time, 1, 1e-6);
}

// By hand: panes come down on a plate by nearly 1. One is 1 above it, a corner of another 0.95.
TEST(TimeOfImpact, FindsWhatIsNearerThanAPairAtTheEndOfTheWay) {
    TestMesh mesh = slanted_panes(1, 0.95);
    for (const std::size_t corner : {25, 26}) {
        mesh.positions[corner].x -= 0.5 * std::sqrt(0.5);
        mesh.positions[corner].z += 0.5 * std::sqrt(0.5);
    }
    const OpenModel plate = open_slanted(slanted_plate()), panes = open_slanted(mesh);
    Workspace workspace;
    for (int k = 0; k < 40; ++k) {
        const double way = (1 - 1.17e-9 + k * 1e-12) * std::sqrt(0.5);
        const Impact impact = time_of_impact(
            {plate.model, panes.model, Motion(), shifted({way, 0, -way})}, workspace);
        ASSERT_EQ(impact.kind, ImpactKind::touching) << k;
        EXPECT_NEAR(impact.upper, 0.95, 1e-8);
    }
}

TEST(TimeOfImpact, IsZeroForModelsThatTouchAtTheStart) {
    const TestMesh box = unit_cube();
    const Case touching = {
        open_tiny(box), open_tiny(moved_by(box, 1, {1, 0, 0})), {}, shifted({5, 0, 0})};
    const Impact impact = touching.ask();
    EXPECT_EQ(impact.kind, ImpactKind::touching);
    EXPECT_EQ(impact.lower, 0);
    EXPECT_EQ(impact.upper, 0);
    EXPECT_FALSE(impact.nearest.has_value());
}

TEST(TimeOfImpact, OfASolidInsideIsZero) {
    const Case inside = {open_tiny(moved_by(unit_cube(), 8, {-4, -4, -4})),
                         open_tiny(unit_cube()),
                         {},
                         shifted({6, 0, 0})};
    expect_impact(inside, 0.5);
    const Impact solid = inside.ask(0, Body::solid);
    EXPECT_EQ(solid.kind, ImpactKind::touching);
    EXPECT_EQ(solid.upper, 0);
}

TEST(TimeOfImpact, OfModelsThatStayOrMoveTogetherIsNone) {
    const TestMesh box = unit_cube();
    const TestMesh other = moved_by(box, 1, {1 + 0x1p-20, 0, 0});
    const Case still = {open_tiny(box), open_tiny(other)};
    EXPECT_EQ(still.ask().kind, ImpactKind::none);
    EXPECT_EQ(still.ask().steps, 1U);
    const Case together = {open_tiny(box), open_tiny(other), shifted({3, 4, 5}),
                           shifted({3, 4, 5})};
    EXPECT_EQ(together.ask().kind, ImpactKind::none);
    const Case away = {open_tiny(box), open_tiny(other), {}, shifted({100, 0, 0})};
    EXPECT_EQ(away.ask().kind, ImpactKind::none);
}

TEST(TimeOfImpact, OfAnEmptyModelIsNone) {
    const Case empty = {open_tiny(TestMesh{}), open_tiny(unit_cube())};
    EXPECT_EQ(empty.ask().kind, ImpactKind::none);
    EXPECT_EQ(empty.ask().steps, 0U);
    EXPECT_EQ(empty.ask().lower, 1);
    EXPECT_EQ(empty.ask().upper, kInfinity);
}

TEST(TimeOfImpact, SaysWhenItRunsOutOfSteps) {
    const Case of = {open_tiny(icosphere(2)),
                     open_tiny(icosphere(2)),
                     {},
                     Motion::by_velocity(Pose::from_quaternion(1, 0, 0, 0, {9, 0, 0}).value(),
                                         {-9, 0, 0}, {5, 5, 5})
                         .value()};
    Workspace workspace;
    const Impact whole = of.ask(1e-9);
    ASSERT_EQ(whole.kind, ImpactKind::touching);
    double last = 0;
    for (std::uint32_t steps = 0; steps < whole.steps; ++steps) {
        const Impact impact = time_of_impact({of.a.model, of.b.model, of.motion_a, of.motion_b},
                                             workspace, {.tolerance = 1e-9, .most_steps = steps});
        EXPECT_EQ(impact.kind, ImpactKind::unfinished);
        EXPECT_EQ(impact.steps, steps);
        EXPECT_GE(impact.lower, last);
        EXPECT_LE(impact.lower, whole.upper);
        last = impact.lower;
    }
}

TEST(TimeOfImpact, ScalesWithTheModel) {
    for (const int exponent : {-950, -600, -60, -20, 0, 20, 60, 600, 950}) {
        const double scale = std::ldexp(1, exponent);
        const TestMesh ball = moved_by(icosphere(2), scale, {});
        const TinyOptions doubles = {.double_precision = true};
        const Case of = {
            open_tiny(ball, doubles),
            open_tiny(ball, doubles),
            {},
            Motion::by_velocity(Pose::from_quaternion(1, 0, 0, 0, {4 * scale, 0, 0}).value(),
                                {-4 * scale, scale / 2, 0}, {1, 2, 3})
                .value()};
        const Impact impact = of.ask(scale * 1e-6);
        ASSERT_EQ(impact.kind, ImpactKind::touching) << exponent;
        EXPECT_LE(impact.upper - impact.lower, 1e-6);
        EXPECT_NEAR(impact.lower, 0.5, 0.05);
    }
}

// Straight ahead at extreme sizes, where the squares of speeds leave the range of double.
TEST(TimeOfImpact, OfExtremeSizesMissesNoContact) {
    for (const int exponent : {-950, -600, -540, 0, 540, 950}) {
        const double scale = std::ldexp(1, exponent);
        const TestMesh box = moved_by(unit_cube(), scale, {});
        const TinyOptions doubles = {.double_precision = true};
        const Case of = {open_tiny(box, doubles),
                         open_tiny(moved_by(unit_cube(), scale, {1.6 * scale, 0, 0}), doubles),
                         {},
                         shifted({-scale, 0, 0})};
        const Impact impact = of.ask();
        ASSERT_EQ(impact.kind, ImpactKind::touching) << exponent;
        EXPECT_LE(impact.lower, 0.6 + 1e-12);
        EXPECT_GE(impact.upper, 0.6 - 1e-12);
    }
}

TEST(TimeOfImpact, TakesAnyTolerance) {
    const Case of = {open_tiny(unit_cube()),
                     open_tiny(moved_by(unit_cube(), 1, {3, 0, 0})),
                     {},
                     shifted({-8, 0, 0})};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double tolerance : {nan, -1.0, -kInfinity, 0.0}) {
        const Impact impact = of.ask(tolerance);
        EXPECT_EQ(impact.kind, ImpactKind::touching) << tolerance;
        EXPECT_NEAR(impact.lower, 0.25, 1e-9);
    }
    EXPECT_NE(of.ask(kInfinity).kind, ImpactKind::none);
}

TEST(TimeApart, IsTheTimeInWhichAGapCloses) {
    EXPECT_EQ(time_apart(0, 1, 1), 0);
    EXPECT_EQ(time_apart(-1, -1, 0), 0);
    EXPECT_EQ(time_apart(3, 2, 0), 1.5);
    EXPECT_EQ(time_apart(3, 0, 0), kInfinity);
    EXPECT_EQ(time_apart(3, -2, 0), kInfinity);
    EXPECT_DOUBLE_EQ(time_apart(1, 0, 2), 1);
    EXPECT_DOUBLE_EQ(time_apart(2, 1, 2), 1);
    // It opens at first: the gap hardly counts.
    EXPECT_DOUBLE_EQ(time_apart(1e-16, -10, 100), 0.2);
    EXPECT_DOUBLE_EQ(time_apart(1e-300, -10, 100), 0.2);
    // Scaled by any power of two, the time is the same.
    for (const int exponent : {-1000, -600, 600, 980}) {
        const double scale = std::ldexp(1, exponent);
        EXPECT_DOUBLE_EQ(time_apart(2 * scale, scale, 2 * scale), 1) << exponent;
        EXPECT_DOUBLE_EQ(time_apart(0.6 * scale, scale, 0), 0.6) << exponent;
        EXPECT_DOUBLE_EQ(time_apart(scale, -scale, 4 * scale), 1) << exponent;
    }
}

/// A random mesh of few triangles, and a random motion through it.
struct Flights {
    std::mt19937 random{7};

    Case next(int round) {
        const TestMesh a = round % 3 == 0 ? random_soup(random(), 6, 0.7) : icosphere(round % 2);
        const TestMesh b = round % 5 == 0 ? random_soup(random(), 3, 0.3)
                                          : moved_by(icosphere(0), 0.3, fine_point(random, 0.2));
        const Pose start = random_pose(random, 2.5), end = random_pose(random, 2.5);
        Motion motion = Motion::between(start, end, fine_point(random, 0.5)).value();
        if (round % 4 == 0) {
            motion =
                Motion::by_velocity(start, fine_point(random, 4), fine_point(random, 9)).value();
        }
        Motion other =
            round % 7 == 0
                ? Motion::between(random_pose(random, 0.3), random_pose(random, 0.3)).value()
                : Motion();
        return {open_tiny(a), open_tiny(b), other, motion};
    }
};

// Dense samples are the oracle: before `lower` none touches, and where one touches there is an
// impact.
TEST(TimeOfImpactLaws, DenseSamplesFindNothingThatItMisses) {
    const int rounds = asks_all() ? 100'000 : 4'000;
    constexpr int kSamples = 64;
    Flights flights;
    Workspace workspace;
    int found = 0, near = 0;
    for (int round = 0; round < rounds; ++round) {
        const Case of = flights.next(round);
        const Impact impact = time_of_impact({of.a.model, of.b.model, of.motion_a, of.motion_b},
                                             workspace, {.tolerance = 1e-4});
        ASSERT_NE(impact.kind, ImpactKind::unfinished) << round;
        found += impact.kind == ImpactKind::touching ? 1 : 0;
        near += impact.kind == ImpactKind::near ? 1 : 0;
        if (impact.upper < kInfinity) {
            ASSERT_TRUE(of.touch_at(impact.upper)) << round;
        }
        for (int i = 0; i <= kSamples; ++i) {
            const double time = impact.lower * i / kSamples;
            if (time >= impact.lower && impact.kind != ImpactKind::none) continue;
            const Placement placement =
                Placement::world(of.motion_a.at(time), of.motion_b.at(time));
            ASSERT_NE(collide({of.a.model, of.b.model, placement}, workspace).hit, Answer::yes)
                << round << " at " << time;
        }
    }
    EXPECT_GT(found, rounds / 5);
    EXPECT_LT(found, rounds * 4 / 5);
    EXPECT_LT(near, rounds / 100);
}

// The interval must hold the first contact of all times, which bisection of samples brackets.
TEST(TimeOfImpactLaws, TheIntervalIsNarrow) {
    Flights flights;
    Workspace workspace;
    int wide = 0, found = 0;
    for (int round = 0; round < 1'000; ++round) {
        const Case of = flights.next(round);
        const Impact impact = time_of_impact({of.a.model, of.b.model, of.motion_a, of.motion_b},
                                             workspace, {.tolerance = 1e-6});
        if (impact.kind != ImpactKind::touching || impact.upper == 0) continue;
        ++found;
        wide += impact.upper - impact.lower > 1e-6 ? 1 : 0;
        ASSERT_TRUE(impact.nearest.has_value());
        EXPECT_LE(impact.nearest->lower, 1e-3);
    }
    EXPECT_GT(found, 200);
    EXPECT_LE(wide, found / 100);
}

}  // namespace
}  // namespace cdprep::test
