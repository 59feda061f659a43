// SPDX-License-Identifier: MIT
#include "study/pose_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "cdprep/collide.h"
#include "cdprep/distance.h"
#include "study/memory_model.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

MemoryModel model_of(const test::TestMesh& mesh) {
    return make_memory_model(test::mesh_of(mesh)).value();
}

TEST(StratumOf, EndsBelongToTheNarrowerOne) {
    EXPECT_EQ(stratum_of(true, 0.15, 0), Stratum::deep);
    EXPECT_EQ(stratum_of(true, 0.0101, 0), Stratum::deep);
    EXPECT_EQ(stratum_of(true, 0.01, 0), Stratum::shallow);
    EXPECT_EQ(stratum_of(true, 0.001, 0), Stratum::touching);
    EXPECT_EQ(stratum_of(true, 0, 0), Stratum::touching);
    EXPECT_EQ(stratum_of(false, 0, 1e-3), Stratum::touching);
    EXPECT_EQ(stratum_of(false, 0, 0.05), Stratum::near);
    EXPECT_EQ(stratum_of(false, 0, 1), Stratum::far);
    EXPECT_EQ(stratum_of(false, 0, 1.01), std::nullopt);
    EXPECT_EQ(stratum_of(true, 0.16, 0), std::nullopt);
}

// The answers are those of the questions, asked anew.
TEST(PoseSet, EveryPoseIsInItsStratum) {
    const MemoryModel a = model_of(test::torus(1, 0.4, 40, 20));
    const MemoryModel b = model_of(test::icosphere(3));
    const PoseSet set = make_pose_set(a.model, b.model, {.seed = 3, .per_stratum = 12});
    EXPECT_EQ(set.poses.size(), 12 * kStrata);
    Workspace workspace;
    std::size_t touching_hits = 0;
    for (const StudyPose& pose : set.poses) {
        const Placement placement = Placement::b_moves(pose.a_from_b);
        EXPECT_EQ(collide(a.model, b.model, placement, workspace).hit, pose.hit);
        const auto apart = distance(a.model, b.model, placement, workspace);
        EXPECT_EQ(apart->lower, pose.gap_lower);
        EXPECT_EQ(apart->upper, pose.gap_upper);
        EXPECT_EQ(stratum_of(pose.hit, pose.depth / set.diagonal, pose.gap_upper / set.diagonal),
                  pose.stratum);
        EXPECT_NE(pose.solid, Answer::unknown);
        if (pose.stratum == Stratum::touching && pose.hit) ++touching_hits;
    }
    EXPECT_EQ(touching_hits, 6U);
    for (std::size_t i = 0; i < kStrata; ++i) {
        EXPECT_EQ(set.of(static_cast<Stratum>(i)).size(), 12U);
        EXPECT_EQ(set.missing[i], 0U);
    }
}

// Of balls of radius 1 and straight ways in the depth is known: going back by it, the middles
// are as far apart as those of balls that touch, 2, but for the balls' flat faces.
TEST(PoseSet, DepthIsTheWayBackToTheFirstTouch) {
    const MemoryModel ball = model_of(test::icosphere(4));
    const PoseSet set = make_pose_set(ball.model, ball.model, {.seed = 5, .per_stratum = 10});
    for (const StudyPose& pose : set.poses) {
        const Double3& t = pose.a_from_b.translation();
        const double middles = std::hypot(t.x, t.y, t.z);
        if (pose.hit) {
            EXPECT_GE(middles, 2 - pose.depth - 0.01);
            EXPECT_LE(middles, 2.0 + 1e-9);
        } else {
            EXPECT_NEAR(middles, 2 + pose.gap_upper, 0.01);
        }
    }
}

// The rounding of a pose is some 1e-15: far below all but the narrowest touches.
TEST(PoseSet, MostAnswersHoldForTheExactRotationToo) {
    const MemoryModel ball = model_of(test::icosphere(3));
    const PoseSet set = make_pose_set(ball.model, ball.model, {.seed = 9, .per_stratum = 20});
    for (const StudyPose& pose : set.poses) EXPECT_TRUE(pose.is_rigid) << pose.depth;
}

TEST(PoseSet, IsTheSameOnThreadsAndBeginsAsASmallerOne) {
    const MemoryModel ball = model_of(test::icosphere(2));
    const auto run = [](std::size_t count, Task task) {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < count; ++i) threads.emplace_back(task, i);
    };
    const PoseSet serial = make_pose_set(ball.model, ball.model, {.seed = 1, .per_stratum = 6});
    const PoseSet threaded =
        make_pose_set(ball.model, ball.model, {.seed = 1, .per_stratum = 6, .parallel_for = run});
    const PoseSet smaller = make_pose_set(ball.model, ball.model, {.seed = 1, .per_stratum = 2});
    ASSERT_EQ(serial.poses.size(), threaded.poses.size());
    for (std::size_t i = 0; i < serial.poses.size(); ++i) {
        EXPECT_EQ(serial.poses[i].a_from_b.rotation(), threaded.poses[i].a_from_b.rotation());
        EXPECT_EQ(serial.poses[i].a_from_b.translation(), threaded.poses[i].a_from_b.translation());
    }
    for (std::size_t i = 0; i < kStrata; ++i) {
        const auto stratum = static_cast<Stratum>(i);
        EXPECT_EQ(serial.poses[serial.of(stratum)[1]].a_from_b.translation(),
                  smaller.poses[smaller.of(stratum)[1]].a_from_b.translation());
    }
    const PoseSet other = make_pose_set(ball.model, ball.model, {.seed = 2, .per_stratum = 2});
    EXPECT_NE(other.poses[0].a_from_b.translation(), smaller.poses[0].a_from_b.translation());
}

// Two sheets in planes of their own meet in a segment however deep they are.
TEST(PoseSet, TakesOpenSurfacesAndOnesOfNothing) {
    const MemoryModel sheet = model_of(test::grid_sheet(6, 5));
    const PoseSet set = make_pose_set(sheet.model, sheet.model, {.seed = 4, .per_stratum = 8});
    EXPECT_GT(set.poses.size(), 30U);
    bool some_unknown = false;
    for (const StudyPose& pose : set.poses) some_unknown |= pose.solid == Answer::unknown;
    EXPECT_TRUE(some_unknown);
    const MemoryModel nothing = model_of({});
    EXPECT_TRUE(make_pose_set(sheet.model, nothing.model).poses.empty());
    const MemoryModel point = model_of({{{1, 2, 3}}, {{{0, 0, 0}}}});
    EXPECT_TRUE(make_pose_set(point.model, point.model).poses.empty());
}

}  // namespace
}  // namespace cdprep::study
