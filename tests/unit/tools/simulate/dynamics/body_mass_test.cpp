// SPDX-License-Identifier: MIT
#include "simulate/dynamics/body_mass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/dynamics/rigid_state.h"
#include "study/memory_model.h"
#include "support/meshes.h"
#include "unit/tools/soup_of.h"

namespace cdprep::dynamics {
namespace {

// By the definition: the axes turn the diagonal back into the tensor.
TEST(PrincipalAxes, MakeTheTensorAgain) {
    const std::array<double, 6> tensor = {5, 4, 3, 0.5, -0.7, 0.2};  // xx yy zz xy yz zx
    const PrincipalAxes found = principal_axes(tensor);
    const auto& axes = found.axes;
    const Double3& moments = found.moments;
    const auto entry = [&](std::size_t i, std::size_t j) {
        return axes[3 * i] * moments.x * axes[3 * j] +
               axes[3 * i + 1] * moments.y * axes[3 * j + 1] +
               axes[3 * i + 2] * moments.z * axes[3 * j + 2];
    };
    EXPECT_NEAR(entry(0, 0), 5, 1e-14);
    EXPECT_NEAR(entry(1, 1), 4, 1e-14);
    EXPECT_NEAR(entry(2, 2), 3, 1e-14);
    EXPECT_NEAR(entry(0, 1), 0.5, 1e-14);
    EXPECT_NEAR(entry(1, 2), -0.7, 1e-14);
    EXPECT_NEAR(entry(2, 0), 0.2, 1e-14);
}

TEST(PrincipalAxes, OfADiagonalTensorStay) {
    const PrincipalAxes found = principal_axes({3, 1, 2, 0, 0, 0});
    EXPECT_EQ(found.axes, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    EXPECT_EQ(found.moments.x, 3);
    EXPECT_EQ(found.moments.z, 2);
}

// By hand: a cube of 2 kg with edges of 1 has the moments m / 6 about its centre.
TEST(BodyMass, OfABalancedModelIsThatOfTheFile) {
    const auto made =
        study::make_memory_model(test::mesh_of(test::unit_cube()), {.pieces = true, .mass = true})
            .value();
    RigidBody body{.model = &made.model, .mass = 2};
    const BodyMass mass = mass_of(body).value();
    EXPECT_EQ(mass.mass, 2);
    EXPECT_FALSE(mass.is_box);
    EXPECT_NEAR(mass.centre.x, 0.5, 1e-15);
    EXPECT_NEAR(mass.moments.x, 1.0 / 3, 1e-15);
    EXPECT_NEAR(mass.radius, std::sqrt(0.75), 1e-15);
    body.mass.reset();
    body.density = 7;
    EXPECT_NEAR(mass_of(body)->mass, 7, 1e-14);
    body.mass = 0;
    EXPECT_EQ(mass_of(body).error().message, "body: the mass is 0, but it must be 1e-30 to 1e+30.");
}

// By hand: a sheet of 2 x 1 as a flat box.
TEST(BodyMass, OfAnUnbalancedModelIsThatOfItsBox) {
    const auto made =
        study::make_memory_model(test::mesh_of(test::grid_sheet(2, 1)), {.pieces = true}).value();
    RigidBody body{.model = &made.model, .name = "sheet"};
    EXPECT_EQ(mass_of(body).error().message,
              "sheet: response needs mass, and the mesh is unbalanced. Give a mass in the scene, "
              "or repair the mesh (bake --repair closed).");
    body.mass = 12;
    const BodyMass mass = mass_of(body).value();
    EXPECT_EQ(mass.mass, 12);
    EXPECT_TRUE(mass.is_box);
    EXPECT_EQ(mass.centre.x, 1);
    EXPECT_NEAR(mass.moments.z, 5, 1e-12);
}

// By symmetry: so many equal turns make a whole one.
TEST(RigidState, MovesByTurnsAboutItsCentre) {
    const Pose start = Pose::from_quaternion(1, 2, 3, 4, {5, 6, 7}).value();
    const Double3 centre = {0.25, -0.5, 1};
    RigidState state = state_of(start, centre);
    constexpr int kTurns = 16;
    for (int i = 0; i < kTurns; ++i) {
        state = moved(state, {0.125, 0, 0}, {0, 0, 2 * 3.14159265358979323846 / kTurns});
    }
    const Pose end = pose_of(state, centre).value();
    EXPECT_NEAR(end.translation().x, 7, 1e-13);
    EXPECT_NEAR(end.translation().y, 6, 1e-13);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(end.rotation()[i], start.rotation()[i], 1e-14);
    }
}

// By each case of the largest part: half turns about the axes, and none.
TEST(RigidState, KeepsEveryPose) {
    for (const auto& q : {std::array<double, 4>{1, 0, 0, 0},
                          {0, 1, 0, 0},
                          {0, 0, 1, 0},
                          {0, 0, 0, 1},
                          {0.1, 0.2, -0.3, 0.9},
                          {-0.1, 0.9, 0.2, 0.3}}) {
        const Pose pose = Pose::from_quaternion(q[0], q[1], q[2], q[3], {1, 2, 3}).value();
        const Pose again = pose_of(state_of(pose, {3, 2, 1}), {3, 2, 1}).value();
        for (std::size_t i = 0; i < 9; ++i) {
            EXPECT_NEAR(again.rotation()[i], pose.rotation()[i], 1e-15);
        }
        EXPECT_NEAR(again.translation().z, 3, 1e-14);
    }
}

/// A flat needle, whose middle axis is y.
BodyMass needle() {
    BodyMass mass;
    mass.mass = 1;
    mass.moments = {0.00083, 0.0834, 0.0842};
    return mass;
}

// The momentum is summed here by the definition, about axes that are not those of the model.
TEST(MovedFreely, KeepsMomentumAndEnergy) {
    BodyMass mass = needle();
    mass.model_from_axes = {0, -1, 0, 1, 0, 0, 0, 0, 1};  // its middle axis is x, backwards
    const auto momentum_and_energy = [&](const FreeMotion& motion) {
        const auto [w, x, y, z] = motion.state.turn;
        const auto r = Pose::from_quaternion(w, x, y, z, {}).value().rotation();
        std::array<double, 4> sums{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& a = mass.model_from_axes;
            const Double3 along = rotated(r, {a[axis], a[3 + axis], a[6 + axis]});
            const double moment = std::array{0.00083, 0.0834, 0.0842}[axis];
            const double spin =
                along.x * motion.spin.x + along.y * motion.spin.y + along.z * motion.spin.z;
            sums[0] += moment * spin * along.x;
            sums[1] += moment * spin * along.y;
            sums[2] += moment * spin * along.z;
            sums[3] += moment * spin * spin;
        }
        return sums;
    };
    FreeMotion motion{{}, {2, 0.3, -0.1}};
    const auto first = momentum_and_energy(motion);
    for (int i = 0; i < 10'000; ++i) {
        motion = moved_freely(mass, motion.state, {1, 0, 0}, motion.spin, {}, 1.0 / 240);
    }
    const auto last = momentum_and_energy(motion);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(last[i], first[i], 1e-11) << i;
    // The rule keeps the energy to the fourth order in the angle of a step: (2 / 240)^4 = 5e-9.
    EXPECT_NEAR(last[3] / first[3], 1, 3e-8);
    EXPECT_EQ(motion.state.centre.x, 10'000);

    // As far as a step may go.
    motion = {{}, {200, 30, -10}};
    const auto fast = momentum_and_energy(motion);
    const double most = most_spin(mass, motion.state, motion.spin);
    const double step = kMostSpinChange / most_spin_change(mass, motion.state, motion.spin);
    for (int i = 0; i < 10'000; ++i) {
        motion = moved_freely(mass, motion.state, {}, motion.spin, {}, step);
        const Double3& w = motion.spin;
        ASSERT_LE(std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z), 1.01 * most);
        ASSERT_NEAR(momentum_and_energy(motion)[3] / fast[3], 1, 1e-3);
    }
}

// The bound holds along the way, and is the spin itself about a principal axis.
TEST(MostSpin, BoundsAFreeBody) {
    const BodyMass mass = needle();
    for (const Double3& first : {Double3{2, 0.3, -0.1}, Double3{0, 2, 1e-3}, Double3{1e-3, 0, 3},
                                 Double3{1, 1, 1}, Double3{5, 0.01, 0}}) {
        FreeMotion motion{{}, first};
        const double most = most_spin(mass, motion.state, first);
        double seen = 0;
        for (int i = 0; i < 5000; ++i) {
            const Double3& w = motion.spin;
            seen = std::max(seen, std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z));
            motion = moved_freely(mass, motion.state, {}, w, {}, 1.0 / 240);
        }
        EXPECT_LE(seen, most * (1 + 1e-6)) << first.x << " " << first.y << " " << first.z;
    }
    EXPECT_NEAR(most_spin(mass, {}, {0, 0, 3}), 3, 1e-3) << "about the largest moment";
    EXPECT_EQ(most_spin(mass, {}, {0, 0, 0}), 0);
    BodyMass ball = mass;
    ball.moments = {2, 2, 2};
    EXPECT_NEAR(most_spin(ball, {}, {1, 2, 2}), 3, 1e-6);
}

// By an integration of Euler's equations in steps of 1e-3 s: the first flip is at this time.
TEST(MovedFreely, FlipsInTime) {
    FreeMotion motion{{}, {1e-3, 2, 0}};
    BodyMass mass = needle();
    mass.moments = {(0.0025 + 2.5e-7) / 3, (0.25 + 2.5e-7) / 3, (0.25 + 0.0025) / 3};
    const auto middle = [&] {
        const auto [w, x, y, z] = motion.state.turn;
        return 2 * (x * y - w * z) * motion.spin.x + (1 - 2 * (x * x + z * z)) * motion.spin.y +
               2 * (y * z + w * x) * motion.spin.z;
    };
    int steps = 0;
    while (middle() > 0 && steps < 2000) {
        motion = moved_freely(mass, motion.state, {}, motion.spin, {}, 1.0 / 240);
        ++steps;
    }
    EXPECT_NEAR(steps / 240.0, 4.539165, 1.0 / 240);
}

}  // namespace
}  // namespace cdprep::dynamics
