// SPDX-License-Identifier: MIT
#include "simulate/page/scene_frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "simulate/page/scene_geometry.h"
#include "simulate/page/scene_timeline.h"
#include "support/random_pose.h"
#include "unit/tools/simulate/page/page_scene.h"

namespace cdprep::report {
namespace {

using test::PageScene;

/// Returns the shown frames of a run, after checking that their poses lead to those of the run.
std::vector<std::uint64_t> shown_frames(std::uint64_t count, const FrameLimits& limits) {
    PageScene scene;
    SceneFrames frames(scene.file(), count, limits);
    std::map<std::uint64_t, std::vector<Pose>> poses;
    scene.run(count, [&](std::uint64_t frame, const scenes::Simulation& simulation) {
        EXPECT_TRUE(frames.add(frame, simulation));
        poses[frame].assign(simulation.poses().begin(), simulation.poses().end());
    });
    std::vector<std::uint64_t> numbers;
    std::map<std::uint32_t, Pose> now;
    for (const ShownFrame& shown : frames.frames()) {
        numbers.push_back(shown.frame);
        EXPECT_TRUE(std::ranges::is_sorted(shown.moved, std::ranges::less{}, &ObjectPose::object));
        for (const ObjectPose& moved : shown.moved) now[moved.object] = moved.pose;
        // Objects 1 and 3 are those in the simulation.
        for (const std::size_t slot : {0U, 1U}) {
            const Pose& found = now.at(slot == 0 ? 1 : 3);
            const Pose& expected = poses.at(shown.frame)[slot];
            EXPECT_EQ(found.rotation(), expected.rotation()) << shown.frame;
            EXPECT_EQ(found.translation().x, expected.translation().x) << shown.frame;
        }
    }
    EXPECT_EQ(now.size(), 4u);
    return numbers;
}

TEST(SceneFrames, ShowsAllFramesThatTheLimitsAllow) {
    EXPECT_EQ(shown_frames(1, {}), std::vector<std::uint64_t>{0});
    EXPECT_EQ(shown_frames(5, {}), (std::vector<std::uint64_t>{0, 1, 2, 3, 4}));
}

TEST(SceneFrames, ShowsEachNthFrameAndTheLast) {
    EXPECT_EQ(shown_frames(20, {.frames = 8}), (std::vector<std::uint64_t>{0, 4, 8, 12, 16, 19}));
    EXPECT_EQ(shown_frames(17, {.frames = 2}), (std::vector<std::uint64_t>{0, 16}));
}

// Poses that only frames between the shown ones have are not lost.
TEST(SceneFrames, LeavesOutFramesWhoseBytesAreTooMany) {
    const std::vector<std::uint64_t> few = shown_frames(40, {.bytes = 6'000});
    ASSERT_GE(few.size(), 3u);
    EXPECT_LT(few.size(), 30u);
    EXPECT_EQ(few.front(), 0u);
    EXPECT_EQ(few.back(), 39u);
    for (std::size_t i = 0; i + 2 < few.size(); ++i) EXPECT_EQ(few[i + 1] - few[i], few[1]);
    EXPECT_EQ(shown_frames(40, {.bytes = 1}), (std::vector<std::uint64_t>{0, 39}));
}

// An object that moves in a frame that is left out, and then no more.
TEST(SceneFrames, KeepsAMotionThatOnlyALeftOutFrameHas) {
    PageScene scene;
    scene.file().motions[1] =
        scenes::Motion::path({{0.25, *Pose::from_quaternion(1, 0, 0, 0, {1000, 0, 0})},
                              {0.5, *Pose::from_quaternion(1, 0, 0, 0, {1001, 0, 0})}});
    SceneFrames frames(scene.file(), 9, {.bytes = 900});
    scene.run(9, [&](std::uint64_t frame, const scenes::Simulation& simulation) {
        EXPECT_TRUE(frames.add(frame, simulation));
    });
    ASSERT_GE(frames.stride(), 4u);
    ASSERT_GE(frames.frames().size(), 2u);
    const std::vector<ObjectPose>& moved = frames.frames()[1].moved;
    ASSERT_EQ(moved.size(), 1u);
    EXPECT_EQ(moved[0].object, 3u);
    EXPECT_EQ(moved[0].pose.translation().x, 1001);
}

// `response` is not asked. pipeline_scene_page has a scene that asks it.
TEST(SceneTimeline, HasAStageForEachEffectThatIsAsked) {
    PageScene scene;
    SceneTimeline timeline;
    scene.run(
        1, [&](std::uint64_t, const scenes::Simulation& simulation) { timeline.add(simulation); });
    EXPECT_EQ(timeline.stages(),
              (std::vector<std::string>{"boxes", "collide", "overlap", "within", "distance",
                                        "contacts", "pair overhead", "lists"}));
}

// By a run without limits: sums and maxima of the frames that a span joins.
TEST(SceneTimeline, JoinsFramesWithoutLosingACount) {
    PageScene scene;
    constexpr std::uint64_t kMany = 2 * SceneTimeline::kMostSpans + 5;
    // To and fro within six frames.
    std::vector<scenes::KeyPose> keys;
    for (std::uint64_t frame = 0; frame < kMany; frame += 3) {
        keys.push_back(
            {static_cast<double>(frame) * scene.file().step_s,
             *Pose::from_quaternion(1, 0, 0, 0, {frame % 2 == 0 ? 1010. : 1004., 0, 0})});
    }
    scene.file().motions[1] = scenes::Motion::path(std::move(keys));
    scene.file().pairs[0].asked.effects = Ask::collide;
    scene.file().pairs[0].asked.tolerance = 0;
    scene.file().pairs[0].asked.max_distance = 0;
    scene.file().pairs[0].asked.contacts = LayerPair{}.contacts;
    SceneTimeline timeline;
    std::vector<std::uint64_t> holds;
    std::uint64_t begins = 0;
    scene.run(kMany, [&](std::uint64_t, const scenes::Simulation& simulation) {
        timeline.add(simulation);
        holds.push_back(simulation.scene().hits().size());
        for (const SceneEvent& event : simulation.scene().events()) {
            begins += event.kind == EventKind::begins ? 1 : 0;
        }
    });
    EXPECT_EQ(timeline.frames_per_span(), 4u);
    EXPECT_LE(timeline.spans().size(), SceneTimeline::kMostSpans);
    std::uint64_t frame = 0;
    std::uint64_t told = 0;
    std::size_t mixed = 0;
    for (const TimelineSpan& span : timeline.spans()) {
        const auto first = holds.begin() + static_cast<std::ptrdiff_t>(frame);
        if (holds[frame] < span.holds[0]) ++mixed;
        EXPECT_EQ(span.holds[0],
                  *std::max_element(first, first + static_cast<std::ptrdiff_t>(span.frames)));
        EXPECT_EQ(span.frames, &span == &timeline.spans().back() ? 1u : 4u);
        EXPECT_GT(span.longest, 0);
        frame += span.frames;
        told += span.begins[0];
    }
    EXPECT_EQ(frame, kMany);
    EXPECT_GT(begins, 1000u);
    EXPECT_GT(mixed, 100u) << "no span begins without the effect and has it later";
    EXPECT_EQ(told, begins);
}

TEST(SceneGeometry, QuaternionsTurnAsTheirMatrix) {
    std::vector<Pose> poses = {Pose()};
    std::mt19937 random(7);
    for (int i = 0; i < 200; ++i) poses.push_back(test::random_pose(random, 0));
    for (const double w : {0.0, 1e-9, 0.3}) {
        poses.push_back(*Pose::from_quaternion(w, 1, 0, 0, {}));
        poses.push_back(*Pose::from_quaternion(w, 0, 1, 0, {}));
        poses.push_back(*Pose::from_quaternion(w, 0, 0, 1, {}));
        poses.push_back(*Pose::from_quaternion(-w, 0.5, -0.5, 0.7, {}));
    }
    for (const Pose& pose : poses) {
        const auto [w, x, y, z] = quaternion_of(pose.rotation());
        EXPECT_GE(w, 0);
        const Result<Pose> again = Pose::from_quaternion(w, x, y, z, {});
        ASSERT_TRUE(again);
        for (std::size_t i = 0; i < 9; ++i) {
            EXPECT_NEAR(again->rotation()[i], pose.rotation()[i], 1e-14);
        }
    }
}

}  // namespace
}  // namespace cdprep::report
