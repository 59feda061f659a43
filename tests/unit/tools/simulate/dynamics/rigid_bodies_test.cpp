// SPDX-License-Identifier: MIT
#include "simulate/dynamics/rigid_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "study/memory_model.h"
#include "support/meshes.h"
#include "unit/tools/soup_of.h"

namespace cdprep::dynamics {
namespace {

/// A cube of edges 1 about the origin, and a floor whose top is z = 0.
struct Models {
    study::MemoryModel cube = baked(test::moved_by(test::unit_cube(), 1, {-0.5, -0.5, -0.5}));
    study::MemoryModel floor = baked(test::moved_by(test::unit_cube(), 8, {-4, -4, -8}));

    static study::MemoryModel baked(const test::TestMesh& mesh) {
        return study::make_memory_model(test::mesh_of(mesh), {.pieces = true, .mass = true})
            .value();
    }
};

Pose at(const Double3& p) {
    return Pose::from_quaternion(1, 0, 0, 0, p).value();
}

class RigidBodiesTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!has_dynamics()) GTEST_SKIP() << make_rigid_bodies().error().message;
    }
    [[nodiscard]] static std::unique_ptr<RigidBodies> make(const DynamicsOptions& options = {}) {
        return make_rigid_bodies(options).value();
    }
    [[nodiscard]] RigidBody floor(BodyKind kind = BodyKind::fixed) const {
        return {.model = &models_.floor.model, .name = "floor", .kind = kind};
    }
    [[nodiscard]] RigidBody cube(const Double3& where) const {
        return {.model = &models_.cube.model, .world_from_model = at(where)};
    }

private:
    Models models_;
};

TEST_F(RigidBodiesTest, NeedAToleranceForTheirSpeed) {
    const auto refused = make_rigid_bodies({.substeps = 1, .most_speed = 3});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message,
              "The contact tolerance is 0.01, but at a speed of 3 it must be at least 0.0505: the "
              "rest gap plus the distance moved in a substep.");
    EXPECT_FALSE(make_rigid_bodies({.step_s = 0}));
    EXPECT_FALSE(make_rigid_bodies({.substeps = 0}));
    EXPECT_FALSE(make_rigid_bodies({.rest_gap = 0}));
}

// By hand: it falls 0.1 and rests at the gap. It feels its weight there.
TEST_F(RigidBodiesTest, ABoxComesToRestAndSleeps) {
    const auto bodies = make({.rest_gap = 1e-3});
    ASSERT_TRUE(bodies->add_body(floor()));
    const auto box = bodies->add_body(cube({0, 0, 0.6})).value();
    for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(bodies->step());
    EXPECT_NEAR(bodies->centre_of_mass(box).z, 0.501, 1e-5);
    double impulse = 0;
    for (const BodyContact& contact : bodies->contacts()) {
        EXPECT_EQ(contact.a, 0U);
        EXPECT_EQ(contact.b, box);
        EXPECT_NEAR(contact.normal.z, 1, 1e-6);
        EXPECT_NEAR(contact.distance, 1e-3, 1e-5);
        impulse += contact.impulse;
    }
    EXPECT_NEAR(impulse, 1000 * 9.81 / 240, 0.1);
    EXPECT_FALSE(bodies->is_asleep(box));
    for (int frame = 0; frame < 180; ++frame) ASSERT_TRUE(bodies->step());
    EXPECT_TRUE(bodies->is_asleep(box));
    EXPECT_EQ(bodies->kinetic_energy(), 0);
    EXPECT_EQ(bodies->counts().pairs, 0U);  // nothing moved, so nothing is asked
}

// By hand: in free flight, z = 5 + 3 t - 9.81 t^2 / 2.
TEST_F(RigidBodiesTest, AFreeBodyFliesAlongAParabola) {
    const auto bodies = make();
    RigidBody ball = cube({0, 0, 5});
    ball.velocity = {1, 0, 3};
    const auto body = bodies->add_body(ball).value();
    for (int frame = 0; frame < 30; ++frame) ASSERT_TRUE(bodies->step());
    EXPECT_NEAR(bodies->centre_of_mass(body).x, 0.5, 1e-6);
    EXPECT_NEAR(bodies->centre_of_mass(body).z, 5 + 1.5 - 9.81 / 8, 1e-6);
    EXPECT_NEAR(bodies->velocity(body).z, 3 - 9.81 / 2, 1e-5);
}

// By hand: without friction the floor pushes upward alone, through the centre of a box that lands
// flat. So it keeps its speed along the floor and does not turn.
TEST_F(RigidBodiesTest, AnObliqueBounceMakesNoSpin) {
    const auto bodies = make({.gravity = {0, 0, 0}, .sleeps = false});
    RigidBody slippery = floor();
    slippery.friction = 0;
    ASSERT_TRUE(bodies->add_body(slippery));
    RigidBody box = cube({-1, 0, 0.7});
    box.friction = 0;
    box.restitution = 0.8;
    box.velocity = {2, 0, -2};
    const auto body = bodies->add_body(box).value();
    for (int frame = 0; frame < 30; ++frame) ASSERT_TRUE(bodies->step());
    EXPECT_NEAR(bodies->velocity(body).x, 2, 1e-4);
    EXPECT_NEAR(bodies->velocity(body).z, 1.6, 1e-4);
    const Double3 spin = bodies->angular_velocity(body);
    for (const double turn : {spin.x, spin.y, spin.z}) EXPECT_NEAR(turn, 0, 1e-4);
}

// The second cube is in a group that the floor does not push.
TEST_F(RigidBodiesTest, OnlyPairedGroupsPushEachOther) {
    const auto bodies = make({.groups = {{1, 0}}});
    ASSERT_TRUE(bodies->add_body(floor()));
    RigidBody held = cube({-1, 0, 0.6}), falls = cube({1, 0, 0.6});
    held.group = 1;
    falls.group = 2;
    ASSERT_TRUE(bodies->add_body(held));
    ASSERT_TRUE(bodies->add_body(falls));
    for (int frame = 0; frame < 30; ++frame) ASSERT_TRUE(bodies->step());
    EXPECT_NEAR(bodies->centre_of_mass(1).z, 0.5, 1e-3);
    EXPECT_NEAR(bodies->centre_of_mass(2).z, 0.6 - 9.81 / 8, 1e-6);
    EXPECT_EQ(bodies->counts().pairs, 4U) << "one pair of bodies in each substep";
}

// Groups that all push each other are as none.
TEST_F(RigidBodiesTest, GroupsChangeNothingThatIsPaired) {
    std::vector<std::uint64_t> hashes;
    for (const bool has_groups : {false, true}) {
        DynamicsOptions options;
        if (has_groups) options.groups = {{0, 1}, {1, 1}};
        const auto bodies = make(options);
        ASSERT_TRUE(bodies->add_body(floor()));
        for (const double z : {0.6, 1.7}) {
            RigidBody box = cube({0.1 * z, 0, z});
            box.group = has_groups ? 1 : 0;
            ASSERT_TRUE(bodies->add_body(box));
        }
        for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(bodies->step());
        hashes.push_back(bodies->state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// By hand: each group of cubes needs two layers, one for slow and one for fast ones.
TEST_F(RigidBodiesTest, RefuseTooManyGroups) {
    const auto bodies = make();
    RigidBody box = cube({0, 0, 5});
    box.name = "box";
    for (box.group = 0; box.group < 16; ++box.group) ASSERT_TRUE(bodies->add_body(box));
    const auto refused = bodies->add_body(box);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message,
              "box: the groups and kinds of bodies need 34 layers; at most 32 are supported.");
    box.group = 3;
    EXPECT_TRUE(bodies->add_body(box));
    EXPECT_EQ(bodies->body_count(), 17U);
    EXPECT_TRUE(bodies->step());
}

// By hand: a bounce reverses the speed and keeps 0.8 of it, so its impulse is 1.8 m v.
TEST_F(RigidBodiesTest, ABounceHasAnImpulse) {
    const auto bodies =
        make({.gravity = {0, 0, 0}, .step_s = 1.0 / 240, .substeps = 1, .sleeps = false});
    ASSERT_TRUE(bodies->add_body(floor()));
    RigidBody box = cube({0, 0, 0.7});
    box.mass = 3;
    box.restitution = 0.8;
    box.velocity = {0, 0, -2};
    ASSERT_TRUE(bodies->add_body(box));
    double impulse = 0;
    for (int frame = 0; frame < 120; ++frame) {
        ASSERT_TRUE(bodies->step());
        for (const BodyContact& contact : bodies->contacts()) impulse += contact.impulse;
    }
    EXPECT_NEAR(impulse, 1.8 * 3 * 2, 1e-3);
}

// A point of a box that turns is fast.
TEST_F(RigidBodiesTest, TooFastCountsTurns) {
    const auto too_fast = [&](const Double3& velocity, const Double3& turn) {
        const auto bodies = make({.gravity = {0, 0, 0}, .most_speed = 2});
        RigidBody box = cube({0, 0, 5});
        box.velocity = velocity;
        box.angular_velocity = turn;
        EXPECT_TRUE(bodies->add_body(box));
        EXPECT_TRUE(bodies->step());
        return bodies->counts().too_fast;
    };
    // By hand: the corners are sqrt(0.75) from the centre.
    EXPECT_EQ(too_fast({1.9, 0, 0}, {0, 0, 0}), 0U);
    EXPECT_EQ(too_fast({2.1, 0, 0}, {0, 0, 0}), 4U) << "in each substep";
    EXPECT_EQ(too_fast({1, 0, 0}, {0, 0, 1}), 0U);
    EXPECT_EQ(too_fast({1, 0, 0}, {0, 0, 1.2}), 4U);
}

// A fast body that gravity drives against another one stops there, and never creeps through.
TEST_F(RigidBodiesTest, AContinuousBodyNeverCreepsThrough) {
    const auto bodies = make({.gravity = {0, 0, -1000}, .sleeps = false});
    ASSERT_TRUE(bodies->add_body(floor()));
    RigidBody ball = cube({0, 0, 20});
    ball.is_continuous = true;
    ball.velocity = {0, 0, -400};
    ASSERT_TRUE(bodies->add_body(ball));
    std::uint64_t impacts = 0;
    for (int frame = 0; frame < 10'000; ++frame) {
        ASSERT_TRUE(bodies->step());
        impacts += bodies->counts().impacts;
        ASSERT_GT(bodies->centre_of_mass(1).z, 0.5 - 0.01) << frame;
    }
    EXPECT_GE(impacts, 1U);
    EXPECT_LT(bodies->centre_of_mass(1).z, 0.52) << "it rests on the floor";
}

// A continuous body passes through a body of a group that it is not paired with.
TEST_F(RigidBodiesTest, AContinuousBodyStopsAtPairedGroupsAlone) {
    const auto bodies = make({.gravity = {0, 0, 0}, .sleeps = false, .groups = {{0, 1}}});
    ASSERT_TRUE(bodies->add_body(floor()));
    RigidBody other = cube({0, 0, 10});
    other.kind = BodyKind::fixed;
    other.group = 2;
    ASSERT_TRUE(bodies->add_body(other));
    RigidBody ball = cube({0, 0, 20});
    ball.group = 1;
    ball.is_continuous = true;
    ball.velocity = {0, 0, -100};
    const auto number = bodies->add_body(ball).value();
    std::vector<std::uint32_t> met;
    for (int frame = 0; frame < 30; ++frame) {
        ASSERT_TRUE(bodies->step());
        for (const BodyImpact& impact : bodies->impacts()) met.push_back(impact.other);
    }
    ASSERT_FALSE(met.empty());
    for (const std::uint32_t one : met) EXPECT_EQ(one, 0U) << "the floor";
    EXPECT_GT(bodies->centre_of_mass(number).z, 0.5 - 0.01) << "on the floor";
    EXPECT_LT(bodies->centre_of_mass(number).z, 5) << "below the body that it passed";
}

// Each flies 4 times its size in a substep. Whichever of them is continuous, they meet.
TEST_F(RigidBodiesTest, BodiesThatFlyAtEachOtherDoNotPass) {
    for (const int continuous : {1, 2, 3}) {
        const auto bodies = make({.gravity = {0, 0, 0}, .sleeps = false});
        RigidBody left = cube({-5, 0, 0}), right = cube({5, 0, 0});
        left.velocity = {1000, 0, 0};
        right.velocity = {-1000, 0, 0};
        left.is_continuous = (continuous & 1) != 0;
        right.is_continuous = (continuous & 2) != 0;
        ASSERT_TRUE(bodies->add_body(left));
        ASSERT_TRUE(bodies->add_body(right));
        std::vector<BodyImpact> impacts;
        for (int frame = 0; frame < 10; ++frame) {
            ASSERT_TRUE(bodies->step());
            const auto met = bodies->impacts();
            impacts.insert(impacts.end(), met.begin(), met.end());
        }
        ASSERT_FALSE(impacts.empty());
        // By hand: 9 lie between them.
        EXPECT_NEAR(impacts[0].time_s, 9.0 / 2000, 1e-5) << continuous;
        const double apart = bodies->centre_of_mass(1).x - bodies->centre_of_mass(0).x;
        EXPECT_GT(apart, 0.999) << continuous;
        EXPECT_NEAR(bodies->velocity(0).x, bodies->velocity(1).x, 1) << "none bounces";
    }
}

// By hand: at 10 m each 1/240 s, the one behind never comes nearer.
TEST_F(RigidBodiesTest, AContinuousBodyMayFollowAnother) {
    const auto bodies = make({.gravity = {0, 0, 0}, .sleeps = false});
    for (const double x : {0.0, 1.5}) {
        RigidBody one = cube({x, 0, 0});
        one.velocity = {2400, 0, 0};
        one.is_continuous = true;
        ASSERT_TRUE(bodies->add_body(one));
    }
    for (int frame = 0; frame < 3; ++frame) {
        ASSERT_TRUE(bodies->step());
        EXPECT_TRUE(bodies->impacts().empty());
    }
    EXPECT_NEAR(bodies->centre_of_mass(0).x, 120, 1e-5) << "Bullet has the substep as a float";
}

// A driven floor that comes up by many times its way to the box takes it along.
TEST_F(RigidBodiesTest, ADrivenBodyTakesAContinuousOneAlong) {
    const auto bodies = make({.gravity = {0, 0, 0}, .sleeps = false});
    const auto moving = bodies->add_body(floor(BodyKind::driven)).value();
    RigidBody box = cube({0, 0, 2});
    box.is_continuous = true;
    const auto number = bodies->add_body(box).value();
    double height = 0;
    for (int frame = 0; frame < 5; ++frame) {
        height += 20;
        ASSERT_TRUE(bodies->drive(moving, at({0, 0, height})));
        ASSERT_TRUE(bodies->step());
        EXPECT_GE(bodies->centre_of_mass(number).z, height + 0.5 - 1e-3) << frame;
    }
}

// The bar turns by 2 pi in each substep, so all its poses are alike. A post is in its way.
TEST_F(RigidBodiesTest, AContinuousBodyTurnsFartherThanPi) {
    const auto bodies = make({.gravity = {0, 0, 0}, .sleeps = false});
    RigidBody post = cube({2.5, 2.5, 0});
    post.kind = BodyKind::fixed;
    ASSERT_TRUE(bodies->add_body(post));
    test::TestMesh mesh = test::moved_by(test::unit_cube(), 1, {-0.5, -0.5, -0.5});
    for (Double3& p : mesh.positions) p = {8 * p.x, 0.5 * p.y, 0.5 * p.z};
    const study::MemoryModel bar = Models::baked(mesh);
    const RigidBody turning = {.model = &bar.model,
                               .name = "bar",
                               .is_continuous = true,
                               .angular_velocity = {0, 0, 480 * std::numbers::pi}};
    ASSERT_TRUE(bodies->add_body(turning));
    ASSERT_TRUE(bodies->step());
    ASSERT_FALSE(bodies->impacts().empty());
    // By hand: the upper side of the bar meets the corner (3, 2) first.
    const double angle = std::atan2(2.0, 3.0) - std::asin(0.25 / std::hypot(3.0, 2.0));
    EXPECT_NEAR(bodies->impacts()[0].time_s, angle / (480 * std::numbers::pi), 1e-6);

    RigidBody faster = turning;
    faster.angular_velocity.z = 300'000;
    faster.world_from_model = at({0, 0, 20});
    ASSERT_TRUE(bodies->add_body(faster));
    const auto refused = bodies->step();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message.find("bar: may turn by 125"), 0u) << refused.error().message;
    EXPECT_NE(refused.error().message.find("up to 1000. Use more substeps."), std::string::npos);
}

// Turns by more than a radian in a substep, about no principal axis.
TEST_F(RigidBodiesTest, ATumblingBodyKeepsItsEnergy) {
    test::TestMesh mesh = test::moved_by(test::unit_cube(), 1, {-0.5, -0.5, -0.5});
    for (Double3& p : mesh.positions) p = {8 * p.x, p.y, 0.5 * p.z};
    const study::MemoryModel bar = Models::baked(mesh);
    for (const bool is_continuous : {false, true}) {
        const auto bodies = make({.gravity = {0, 0, 0}, .sleeps = false});
        ASSERT_TRUE(bodies->add_body({.model = &bar.model,
                                      .name = "bar",
                                      .is_continuous = is_continuous,
                                      .angular_velocity = {700, 90, 40}}));
        const double first = bodies->kinetic_energy();
        for (int frame = 0; frame < 30; ++frame) {
            ASSERT_TRUE(bodies->step());
            ASSERT_NEAR(bodies->kinetic_energy() / first, 1, 0.01) << frame;
        }
    }
}

TEST_F(RigidBodiesTest, RefuseNumbersThatBulletCannotHold) {
    const auto bodies = make();
    const auto sentence_of = [&](auto change) {
        RigidBody box = cube({0, 0, 5});
        box.name = "box";
        change(box);
        const auto added = bodies->add_body(box);
        return added ? std::string() : added.error().message;
    };
    EXPECT_EQ(sentence_of([](RigidBody& b) { b.friction = -1; }),
              "box: the friction is -1, but it must be 0 to 1e+06.");
    EXPECT_EQ(sentence_of([](RigidBody& b) { b.restitution = 1.5; }),
              "box: the restitution is 1.5, but it must be 0 to 1.");
    EXPECT_EQ(sentence_of([](RigidBody& b) { b.velocity.y = HUGE_VAL; }),
              "box: a velocity is not finite.");
    EXPECT_EQ(sentence_of([](RigidBody& b) { b.mass = 1e-46; }),
              "box: the mass is 1e-46, but it must be 1e-30 to 1e+30.");
    EXPECT_EQ(sentence_of([](RigidBody& b) { b.mass = 1e39; }),
              "box: the mass is 1e+39, but it must be 1e-30 to 1e+30.");
    EXPECT_EQ(bodies->body_count(), 0U);
}

// By hand: friction holds at this acceleration, so a box rides with its floor.
TEST_F(RigidBodiesTest, ADrivenFloorCarriesABox) {
    const auto bodies = make();
    const auto moving = bodies->add_body(floor(BodyKind::driven)).value();
    const auto box = bodies->add_body(cube({0, 0, 0.5005})).value();
    for (int frame = 0; frame < 200; ++frame) ASSERT_TRUE(bodies->step());
    EXPECT_TRUE(bodies->is_asleep(box));
    double speed = 0, way = 0;
    for (int frame = 0; frame < 60; ++frame) {
        speed = std::min(0.5, speed + 1.0 / 60);
        way += speed / 60;
        ASSERT_TRUE(bodies->drive(moving, at({way, 0, 0})));
        ASSERT_TRUE(bodies->step());
    }
    EXPECT_EQ(bodies->pose(moving).translation().x, way);
    EXPECT_NEAR(bodies->centre_of_mass(box).x, way, 5e-3);
    EXPECT_NEAR(bodies->velocity(box).x, 0.5, 1e-3);
    EXPECT_FALSE(bodies->drive(box, at({0, 0, 0})));
}

TEST_F(RigidBodiesTest, RefuseAModelThatLacksSections) {
    const auto made = study::make_memory_model(test::mesh_of(test::unit_cube())).value();
    const auto bodies = make();
    const auto refused = bodies->add_body({.model = &made.model});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, made.model.refusal(Ask::contacts)->message);
}

}  // namespace
}  // namespace cdprep::dynamics
