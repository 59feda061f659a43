// SPDX-License-Identifier: MIT
#include "study/pose_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "cdprep/pairs.h"
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
        EXPECT_EQ(collide({a.model, b.model, placement}, workspace).hit == Answer::yes, pose.hit);
        const auto apart = distance({a.model, b.model, placement}, workspace);
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

/// A set's poses as they are given again.
std::vector<GivenPose> given(const PoseSet& set) {
    std::vector<GivenPose> poses;
    for (const StudyPose& pose : set.poses) poses.push_back({pose.a_from_b, pose.stratum});
    return poses;
}

TEST(AskPoses, GivesADrawnSetAgain) {
    const MemoryModel a = model_of(test::torus(1, 0.4, 40, 20));
    const MemoryModel b = model_of(test::icosphere(3));
    const PoseSet drawn = make_pose_set(a.model, b.model, {.seed = 3, .per_stratum = 4});
    std::vector<GivenPose> poses = given(drawn);
    std::ranges::reverse(poses);  // they are sorted, and keep their order in a stratum
    PoseSet again = ask_poses(a.model, b.model, poses, "x.pose");
    EXPECT_EQ(again.source, "x.pose");
    ASSERT_EQ(again.poses.size(), drawn.poses.size());
    EXPECT_NE(hash_of(again), hash_of(drawn));
    again = ask_poses(a.model, b.model, given(drawn), "x.pose");
    EXPECT_EQ(hash_of(again), hash_of(drawn));
    for (std::size_t i = 0; i < drawn.poses.size(); ++i) {
        EXPECT_EQ(again.poses[i].stratum, drawn.poses[i].stratum);
        EXPECT_EQ(again.poses[i].hit, drawn.poses[i].hit);
        EXPECT_EQ(again.poses[i].solid, drawn.poses[i].solid);
        EXPECT_EQ(again.poses[i].gap_upper, drawn.poses[i].gap_upper);
        EXPECT_EQ(again.poses[i].is_rigid, drawn.poses[i].is_rigid);
    }
}

// Boxes of diagonal sqrt(3) side by side: touching ones go by what is said of them, others by
// their distance.
TEST(AskPoses, SortsByTheAnswerAndByWhatIsSaid) {
    const MemoryModel box = model_of(test::unit_cube());
    const auto at = [](double x) {
        const std::array<double, 12> rows = {1, 0, 0, 0, 1, 0, 0, 0, 1, x, 0.25, 0.25};
        return Pose::from_rows(rows).value();
    };
    const std::vector<GivenPose> poses = {
        {at(0.5), {}},
        {at(0.75), Stratum::shallow},
        {at(1), Stratum::touching},
        {at(0.25), Stratum::far},
        {at(1.0625), Stratum::deep},
        {at(1.5), {}},
        {at(9), {}},
    };
    const PoseSet set = ask_poses(box.model, box.model, poses, "by hand");
    const auto xs = [&](Stratum stratum) {
        std::vector<double> found;
        for (const std::size_t i : set.of(stratum)) {
            found.push_back(set.poses[i].a_from_b.translation().x);
        }
        return found;
    };
    EXPECT_EQ(xs(Stratum::deep), (std::vector<double>{0.5, 0.25}));
    EXPECT_EQ(xs(Stratum::shallow), (std::vector<double>{0.75}));
    EXPECT_EQ(xs(Stratum::touching), (std::vector<double>{1}));
    EXPECT_EQ(xs(Stratum::near), (std::vector<double>{1.0625}));
    EXPECT_EQ(xs(Stratum::far), (std::vector<double>{1.5, 9}));
}

TEST(FindStratum, KnowsTheirNames) {
    for (std::size_t i = 0; i < kStrata; ++i) {
        EXPECT_EQ(find_stratum(kStratumNames[i]), static_cast<Stratum>(i));
    }
    EXPECT_EQ(find_stratum("Seed 1."), std::nullopt);
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

// B would have to be moved beyond the range of Pose.
TEST(PoseSet, OfHugeModelsIsEmpty) {
    const auto set_of = [](double size, double middle) {
        test::TestMesh mesh = test::icosphere(1);
        for (format::Double3& p : mesh.positions) {
            p = {size * p.x + middle, size * p.y + middle, size * p.z + middle};
        }
        const MemoryModel a = model_of(mesh);
        const MemoryModel b = model_of(mesh);
        return make_pose_set(a.model, b.model, {.seed = 3, .per_stratum = 2}).poses.size();
    };
    EXPECT_EQ(set_of(0x1p999, 0), 0U);
    EXPECT_EQ(set_of(0x1p980, 0x1p999), 0U);
    EXPECT_EQ(set_of(0x1p995, 0), 2 * kStrata);
}

}  // namespace
}  // namespace cdprep::study
