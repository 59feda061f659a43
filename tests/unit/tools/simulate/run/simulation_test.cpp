// SPDX-License-Identifier: MIT
#include "simulate/run/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "support/brute_force.h"
#include "support/meshes.h"
#include "support/open_tiny.h"
#include "support/run_threads.h"

namespace cdprep::scenes {
namespace {

/// A row of bodies, and as many that move through it. Bodies of the first row all meet.
class Rows {
public:
    Rows(std::uint32_t count, double spacing) {
        file_.name = "rows.json";
        file_.step_s = 0.5;
        file_.layers = {"resting", "moving", "alone"};
        file_.pairs = {{.asked = {.a = 0, .b = 1, .effects = Ask::collide}}};
        file_.models = {"sphere", "unused"};
        file_.motions = {
            Motion::fixed({}),
            Motion::steady(*Pose::from_quaternion(1, 0, 0, 0, {-4, 0, 0}), {1, 0, 0}, {0, 0.5, 0})};
        file_.objects.push_back({.name = "alone", .model = 1, .layer = 2});
        for (std::uint32_t i = 0; i < count; ++i) {
            for (const std::uint32_t layer : {0U, 1U}) {
                file_.objects.push_back({.name = std::to_string(layer) + "," + std::to_string(i),
                                         .layer = layer,
                                         .motion = layer,
                                         .offset = {0, spacing * i, 0}});
            }
        }
        models_.resize(2);
        models_[0].model.emplace(std::move(sphere_.model));
    }
    [[nodiscard]] SceneFile& file() {
        return file_;
    }
    [[nodiscard]] Result<Simulation> make(std::uint32_t threads = 1) const {
        return Simulation::make(file_, models_, threads, test::run_threads);
    }

private:
    SceneFile file_;
    std::vector<SceneModel> models_;
    test::OpenModel sphere_ = test::open_tiny(test::icosphere(1));
};

using Event = std::tuple<std::uint64_t, std::string, std::string, bool>;

/// Returns the events of some frames, in their order.
std::vector<Event> events_of(Simulation& simulation, std::uint64_t frames) {
    std::vector<Event> events;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        const Result<Done> done = simulation.step(frame);
        EXPECT_TRUE(done) << frame;
        for (const SceneEvent& event : simulation.scene().events()) {
            events.emplace_back(frame, simulation.object(event.a).name,
                                simulation.object(event.b).name, event.kind == EventKind::begins);
        }
    }
    return events;
}

constexpr std::uint64_t kFrames = 20;

// By hand: spheres of radius 1 that approach by 0.5 a frame from -4 touch from -2 to 2.
TEST(Simulation, TellsWhatBeginsAndEnds) {
    const Rows rows(3, 10);
    auto simulation = rows.make();
    ASSERT_TRUE(simulation);
    const std::vector<Event> events = events_of(*simulation, kFrames);
    ASSERT_EQ(events.size(), 6u);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& [begin, a, b, begins] = events[i];
        EXPECT_TRUE(begins);
        EXPECT_EQ(a, "0," + std::to_string(i));
        EXPECT_EQ(b, "1," + std::to_string(i));
        EXPECT_TRUE(begin == 4 || begin == 5) << begin;
        const auto& [end, c, d, still] = events[3 + i];
        EXPECT_FALSE(still);
        EXPECT_TRUE(end == 12 || end == 13) << end;
    }
    EXPECT_EQ(simulation->scene().object_count(), 6u) << "an object that nobody asks for";
    EXPECT_EQ(simulation->grown_steps(), 0u);
}

// 100 x 100 pairs meet, for which there is no room at the beginning.
TEST(Simulation, MakesRoomWithoutLosingAnEvent) {
    const Rows rows(100, 0);
    auto grown = rows.make();
    Rows with_room(100, 0);
    with_room.file().most_pairs = 20'000;
    auto large = with_room.make(2);
    ASSERT_TRUE(grown && large);
    const std::vector<Event> events = events_of(*grown, kFrames);
    EXPECT_EQ(events.size(), 20'000u);
    EXPECT_EQ(events, events_of(*large, kFrames));
    EXPECT_EQ(grown->grown_steps(), 1u);
    EXPECT_EQ(large->grown_steps(), 0u);
    EXPECT_EQ(grown->scene().state_hash(), large->scene().state_hash());
}

TEST(Simulation, MakesRoomInTheFirstFrame) {
    Rows rows(100, 0);
    rows.file().motions[1] = Motion::fixed({});
    auto simulation = rows.make();
    ASSERT_TRUE(simulation);
    EXPECT_EQ(events_of(*simulation, 2).size(), 10'000u);
    EXPECT_EQ(simulation->grown_steps(), 1u);
}

TEST(Simulation, EndsWhereTheFileLimitsThePairs) {
    Rows rows(100, 0);
    rows.file().most_pairs = 9'999;
    auto simulation = rows.make();
    ASSERT_TRUE(simulation);
    Result<Done> done = Done{};
    for (std::uint64_t frame = 0; frame < kFrames && done; ++frame) done = simulation->step(frame);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::over_budget);
    EXPECT_NE(done.error().message.find("needs room for 10000 pairs, but limits.pairs is 9999."),
              std::string::npos)
        << done.error().message;
}

// A pair of which nothing has moved is not asked again.
TEST(Simulation, CountsAnObjectThatPausesAsNotMoved) {
    Rows rows(1, 0);
    rows.file().motions[1] =
        Motion::path({{0, Pose()}, {1, *Pose::from_quaternion(1, 0, 0, 0, {0.5, 0, 0})}});
    auto simulation = rows.make();
    ASSERT_TRUE(simulation);
    for (std::uint64_t frame = 0; frame < 5; ++frame) {
        ASSERT_TRUE(simulation->step(frame));
        EXPECT_EQ(simulation->scene().counts().kept, frame > 2 ? 1u : 0u) << frame;
    }
}

TEST(Simulation, NamesAnObjectThatLeavesTheCoordinates) {
    Rows rows(1, 0);
    rows.file().motions[1] = Motion::steady({}, {1e301, 0, 0}, {});
    auto simulation = rows.make();
    ASSERT_TRUE(simulation);
    ASSERT_TRUE(simulation->step(0));
    const Result<Done> done = simulation->step(100);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::bad_argument);
    EXPECT_EQ(done.error().message.substr(0, 24), "rows.json: object '1,0':");
}

const Shear kShear = {.of = 0, .along = 2, .amplitude = 0.75, .period_s = 4};
const Tear kTear = {.point = {0.2, 0, 0}, .normal = {1, 0, 0.5}, .time_s = 4, .opening = 0.5};

// The oracle tests all pairs of triangles of the meshes that the closed form gives.
TEST(Simulation, DeformsTheModelOfItsObjects) {
    Rows rows(2, 10);
    rows.file().changes = {{.deform = kShear}};
    rows.file().pairs[0].asked.effects = Ask::collide | Ask::overlap | Ask::deform;
    for (FileObject& object : rows.file().objects) {
        if (object.layer == 0) object.change = 0;
    }
    auto simulation = rows.make();
    ASSERT_TRUE(simulation) << simulation.error().message;
    ASSERT_EQ(simulation->changing().size(), 1u) << "two objects share a live model";
    EXPECT_EQ(simulation->changing()[0].objects, (std::vector<std::uint32_t>{1, 3}));
    const test::TestMesh ball = test::in_floats(test::icosphere(1));
    std::size_t hits = 0;
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
        ASSERT_TRUE(simulation->step(frame));
        EXPECT_EQ(simulation->change_work().refits, 1u);
        const double time_s = 0.5 * static_cast<double>(frame);
        test::TestMesh now = ball;
        for (Double3& p : now.positions) p.x += kShear.factor(time_s) * p.z;
        now = test::in_floats(now);
        const Pose pose = *rows.file().motions[1].at(time_s, {});
        const auto expected = test::brute_force_pairs(now, ball, Placement::world(Pose(), pose));
        const auto found = simulation->scene().overlaps();
        ASSERT_EQ(found.size(), expected.empty() ? 0u : 2u) << frame;
        if (expected.empty()) continue;
        ++hits;
        EXPECT_TRUE(std::ranges::equal(found[0].triangles, expected)) << frame;
    }
    EXPECT_TRUE(hits > 4 && hits < kFrames) << hits;
}

// Room is made in the frame of the tear: the frame before it is computed again, with whole models.
TEST(Simulation, MakesRoomWhereModelsTear) {
    const auto make = [](std::uint32_t pairs, std::uint32_t threads) {
        Rows rows(60, 0);
        rows.file().changes = {{.deform = kShear, .tear = kTear}};
        rows.file().pairs[0].asked.effects = Ask::collide | Ask::within | Ask::tear;
        if (pairs > 0) rows.file().most_pairs = pairs;
        rows.file().motions[1] = Motion::path({{3.5, *Pose::from_quaternion(1, 0, 0, 0, {9, 0, 0})},
                                               {4, *Pose::from_quaternion(1, 0, 0, 0, {0, 0, 0})}});
        for (FileObject& object : rows.file().objects) {
            if (object.layer == 0) object.change = 0;
        }
        return std::pair(std::move(rows), threads);
    };
    auto [few, one] = make(0, 1);
    auto [many, eight] = make(20'000, 8);
    auto grown = few.make(one), large = many.make(eight);
    ASSERT_TRUE(grown && large);
    std::uint64_t torn = 0;
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
        ASSERT_TRUE(grown->step(frame));
        ASSERT_TRUE(large->step(frame));
        EXPECT_EQ(grown->scene().state_hash(), large->scene().state_hash()) << frame;
        EXPECT_EQ(grown->change_work().torn, large->change_work().torn) << frame;
        EXPECT_EQ(grown->change_work().refits, large->change_work().refits) << frame;
        torn += grown->change_work().torn;
        EXPECT_EQ(torn > 0, frame >= 8) << frame;
    }
    EXPECT_GT(torn, 10u);
    EXPECT_EQ(grown->grown_steps(), 1u);
    EXPECT_EQ(large->grown_steps(), 0u);
}

// The frame before the one that needs room has a way of its own: from two frames before.
TEST(Simulation, MakesRoomWithoutLosingAWay) {
    const auto impacts = [](std::uint32_t pairs, std::uint64_t& grown_steps) {
        Rows rows(36, 0);
        rows.file().pairs[0].asked.effects = Ask::continuous;
        if (pairs > 0) rows.file().most_pairs = pairs;
        // Six pass through all others in frame 2, and are gone in frame 3. Then the rest comes.
        const auto at = [](double x) { return *Pose::from_quaternion(1, 0, 0, 0, {x, 0, 0}); };
        rows.file().motions[1] =
            Motion::path({{0.5, at(60)}, {1, at(-60)}, {1.5, at(-30)}, {2, at(0)}});
        rows.file().motions.push_back(Motion::path({{1, at(90)}, {1.5, at(0)}}));
        std::uint32_t moving = 0;
        for (FileObject& object : rows.file().objects) {
            if (object.layer == 1 && ++moving > 6) object.motion = 2;
        }
        std::vector<Event> events;
        auto simulation = rows.make(2);
        EXPECT_TRUE(simulation);
        if (simulation) events = events_of(*simulation, 6);
        if (simulation) grown_steps = simulation->grown_steps();
        return events;
    };
    std::uint64_t grown = 0, large = 0;
    const std::vector<Event> events = impacts(0, grown);
    EXPECT_EQ(events, impacts(20'000, large));
    EXPECT_EQ(events.size(), 36u * (6 + 6 + 30 + 6));
    EXPECT_EQ(large, 0u);
    EXPECT_GT(grown, 0u);
}

// A shape that stays is asked once.
TEST(Simulation, CountsAShapeThatStaysAsNotMoved) {
    Rows rows(1, 0);
    rows.file().changes = {{.tear = kTear}};
    rows.file().pairs[0].asked.effects = Ask::collide | Ask::tear;
    rows.file().motions[1] = Motion::fixed({});
    rows.file().objects[1].change = 0;
    auto simulation = rows.make();
    ASSERT_TRUE(simulation);
    for (std::uint64_t frame = 0; frame < 12; ++frame) {
        ASSERT_TRUE(simulation->step(frame));
        EXPECT_EQ(simulation->scene().counts().kept, frame == 0 || frame == 8 ? 0u : 1u) << frame;
    }
}

TEST(Simulation, NamesAShapeThatLeavesTheCoordinates) {
    Rows rows(1, 0);
    rows.file().changes = {{.deform = Shear{.of = 0, .along = 2, .rate_per_s = 1e38}}};
    rows.file().pairs[0].asked.effects = Ask::collide | Ask::deform;
    rows.file().objects[1].change = 0;
    auto simulation = rows.make();
    ASSERT_TRUE(simulation);
    ASSERT_TRUE(simulation->step(0));
    const Result<Done> done = simulation->step(100);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::bad_argument);
    EXPECT_EQ(done.error().message.substr(0, 33), "rows.json: object '0,0': at 50 s:")
        << done.error().message;
}

}  // namespace
}  // namespace cdprep::scenes
