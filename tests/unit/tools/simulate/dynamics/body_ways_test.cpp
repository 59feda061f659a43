// SPDX-License-Identifier: MIT
#include "simulate/dynamics/body_ways.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "study/memory_model.h"
#include "support/meshes.h"
#include "unit/tools/soup_of.h"

namespace cdprep::dynamics {
namespace {

constexpr double kTolerance = 1e-6;

study::MemoryModel box_of(const Double3& size) {
    test::TestMesh mesh = test::moved_by(test::unit_cube(), 1, {-0.5, -0.5, -0.5});
    for (Double3& p : mesh.positions) p = {p.x * size.x, p.y * size.y, p.z * size.z};
    return study::make_memory_model(test::mesh_of(mesh), {.pieces = true, .mass = true}).value();
}

Pose placed_at(const Double3& p) {
    return Pose::from_quaternion(1, 0, 0, 0, p).value();
}

class BodyWaysTest : public ::testing::Test {
protected:
    /// A thin plate across the x axis.
    [[nodiscard]] BodyWay plate(const Double3& start, const Double3& shift) const {
        return way_of(plate_.model, start, shift, {}, 0.71);
    }
    [[nodiscard]] BodyWay cube(const Double3& start, const Double3& shift) const {
        return way_of(cube_.model, start, shift, {}, 0.87);
    }
    /// A bar from the middle to x = 2, and back.
    [[nodiscard]] BodyWay bar(double turn) const {
        return way_of(bar_.model, {}, {}, {0, 0, turn}, 2.01);
    }
    static BodyWay way_of(const Model& model, const Double3& start, const Double3& shift,
                          const Double3& turn, double radius) {
        return {.model = &model,
                .motions = {Motion::by_velocity(placed_at(start), shift, turn).value()},
                .centre = {},
                .radius = radius,
                .is_continuous = false,
                .is_free = true};
    }
    std::vector<WayImpact> run(const std::vector<BodyWay>& ways) {
        BodyWays moved(
            ways, [](std::uint32_t, std::uint32_t) { return true; }, workspace_, kTolerance);
        EXPECT_TRUE(moved.run());
        ends_.clear();
        for (std::uint32_t i = 0; i < ways.size(); ++i) {
            ends_.push_back(moved.changed_end(i).value_or(ways[i].motions.back().at(1)));
        }
        return {moved.impacts().begin(), moved.impacts().end()};
    }
    [[nodiscard]] Double3 end(std::size_t body) const {
        return ends_[body].translation();
    }
    [[nodiscard]] const Pose& whole_end(std::size_t body) const {
        return ends_[body];
    }

private:
    study::MemoryModel plate_ = box_of({0.01, 1, 1});
    study::MemoryModel cube_ = box_of({1, 1, 1});
    study::MemoryModel bar_ = box_of({4, 0.1, 0.1});
    Workspace workspace_;
    std::vector<Pose> ends_;
};

// By hand: 2.99 lie between two plates that come nearer by 20.
TEST_F(BodyWaysTest, PlatesThatFlyAtEachOtherMeet) {
    for (const int continuous : {1, 2, 3}) {
        std::vector<BodyWay> ways = {plate({0, 0, 0}, {10, 0, 0}), plate({3, 0, 0}, {-10, 0, 0})};
        ways[0].is_continuous = (continuous & 1) != 0;
        ways[1].is_continuous = (continuous & 2) != 0;
        const auto impacts = run(ways);
        ASSERT_EQ(impacts.size(), 1u);
        EXPECT_EQ(impacts[0].body, continuous == 2 ? 1u : 0u);
        EXPECT_EQ(impacts[0].other, continuous == 2 ? 0u : 1u);
        EXPECT_NEAR(impacts[0].time, 2.99 / 20, kTolerance);
        EXPECT_NEAR(end(0).x, 1.495, 2 * kTolerance);
        EXPECT_NEAR(end(1).x, 1.505, 2 * kTolerance);
        EXPECT_GE(end(1).x - end(0).x, 0.01 - 1e-12);
    }
}

// Who is not continuous has no promise.
TEST_F(BodyWaysTest, OtherBodiesDoNotMeet) {
    EXPECT_TRUE(run({plate({0, 0, 0}, {10, 0, 0}), plate({3, 0, 0}, {-10, 0, 0})}).empty());
    EXPECT_EQ(end(0).x, 10);
}

// By hand: both are at the origin at 1/2, and their edges meet at 0.4. Each alone passes where the
// other is not.
TEST_F(BodyWaysTest, CrossingWaysMeetIfTheTimesAgree) {
    for (const double late : {0.0, 5.0}) {
        std::vector<BodyWay> ways = {cube({-5, 0, 0}, {10, 0, 0}),
                                     cube({0, -5 - late, 0}, {0, 10, 0})};
        ways[0].is_continuous = true;
        const auto impacts = run(ways);
        ASSERT_EQ(impacts.size(), late == 0 ? 1u : 0u);
        for (const WayImpact& impact : impacts) EXPECT_NEAR(impact.time, 0.4, kTolerance);
    }
}

TEST_F(BodyWaysTest, OneThatFliesAfterAnotherMeetsNothing) {
    std::vector<BodyWay> ways = {cube({0, 0, 0}, {10, 0, 0}), cube({1.5, 0, 0}, {10, 0, 0})};
    ways[0].is_continuous = ways[1].is_continuous = true;
    EXPECT_TRUE(run(ways).empty());
    EXPECT_EQ(end(0).x, 10);
}

// By hand: the first two stop at 0.1, x = 1; the third needs 2.5 from 4.5 - 10 t on.
TEST_F(BodyWaysTest, AStoppedBodyIsMetInItsTurn) {
    std::vector<BodyWay> ways = {cube({0, 0, 0}, {10, 0, 0}), cube({3, 0, 0}, {-10, 0, 0}),
                                 cube({5.5, 0, 0}, {-10, 0, 0})};
    for (BodyWay& way : ways) way.is_continuous = true;
    const auto impacts = run(ways);
    ASSERT_EQ(impacts.size(), 2u);
    EXPECT_NEAR(impacts[0].time, 0.1, kTolerance);
    EXPECT_NEAR(end(0).x, 1, 1e-5);
    EXPECT_NEAR(end(1).x, 2, 1e-5);
    EXPECT_NEAR(impacts[1].time, 0.25, kTolerance);
    EXPECT_NEAR(end(2).x, 3, 1e-5);
}

// By hand: a plate that is not free comes from 3 to -7. It meets the cube at 0.25 and takes it 7.5
// along. A wall at -4 stops the cube.
TEST_F(BodyWaysTest, ABodyThatIsNotFreeTakesAlong) {
    for (const bool has_wall : {false, true}) {
        std::vector<BodyWay> ways = {cube({0, 0, 0}, {}), plate({3, 0, 0}, {-10, 0, 0}),
                                     cube({-4, has_wall ? 0.0 : 9.0, 0}, {})};
        ways[0].is_continuous = true;
        ways[1].is_free = ways[2].is_free = false;
        const auto impacts = run(ways);
        ASSERT_EQ(impacts.size(), has_wall ? 2u : 1u);
        EXPECT_NEAR(impacts[0].time, 0.2495, kTolerance);
        EXPECT_NEAR(end(0).x, has_wall ? -3 : -7.505, 1e-5);
        EXPECT_EQ(end(1).x, -7);
    }
}

// By hand: the bar meets the corner (0.5, 1.5) of the cube, which then turns along.
TEST_F(BodyWaysTest, ABodyTurnsWithWhatTakesItAlong) {
    std::vector<BodyWay> ways = {cube({0, 2, 0}, {}), bar(std::numbers::pi / 2)};
    ways[0].is_continuous = true;
    ways[1].is_free = false;
    const auto impacts = run(ways);
    ASSERT_EQ(impacts.size(), 1u);
    EXPECT_NEAR(std::hypot(end(0).x, end(0).y), 2, 1e-9) << "as far from the joint as before";
    EXPECT_LT(end(0).x, -0.2);
    const double angle = std::atan2(1.5, 0.5) - std::asin(0.05 / std::hypot(1.5, 0.5));
    EXPECT_NEAR(impacts[0].time, angle / (std::numbers::pi / 2), 1e-5);
    const double turned = (1 - impacts[0].time) * std::numbers::pi / 2;
    EXPECT_NEAR(whole_end(0).rotation()[0], std::cos(turned), 1e-9);
}

// A way of several motions counts as a whole: back and forth is not standing. By hand: the cube
// moves by 4 in the first half of the time. Its side meets the plate's at 2.995 after 2.495. The
// other plate is at y = 1.5 - 2t. It is in the way once y is at most 1, from 1/4 on. The cube comes
// to its side later, so they meet at the same time.
TEST_F(BodyWaysTest, AWayMayHaveParts) {
    std::vector<BodyWay> ways = {cube({0, 0, 0}, {4, 0, 0}), plate({3, 0, 0}, {})};
    ways[0].motions.push_back(Motion::by_velocity(placed_at({4, 0, 0}), {-4, 0, 0}, {}).value());
    ways[1].is_continuous = true;
    const auto impacts = run(ways);
    ASSERT_EQ(impacts.size(), 1u);
    const double meeting = 0.5 * 2.495 / 4;
    EXPECT_NEAR(impacts[0].time, meeting, kTolerance);
    ways[1] = plate({3, 1.5, 0}, {0, -2, 0});
    ways[1].is_continuous = true;
    const auto later = run(ways);
    ASSERT_EQ(later.size(), 1u);
    EXPECT_NEAR(later[0].time, meeting, kTolerance);
}

}  // namespace
}  // namespace cdprep::dynamics
