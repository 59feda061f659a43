// SPDX-License-Identifier: MIT
#include "simulate/run/response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "simulate/page/scene_frames.h"
#include "simulate/run/simulation.h"
#include "simulate/simulation_report.h"
#include "study/memory_model.h"
#include "support/meshes.h"
#include "support/run_threads.h"
#include "unit/tools/soup_of.h"

namespace cdprep::scenes {
namespace {

study::MemoryModel baked(const test::TestMesh& mesh, bool has_pieces = true) {
    return study::make_memory_model(test::mesh_of(mesh), {.pieces = has_pieces, .mass = has_pieces})
        .value();
}

/// A cube with edges of 1 above a floor whose top is z = 0. The cube is a body, unless told.
class Falling {
public:
    explicit Falling(double height) {
        file_.name = "s.json";
        file_.metres_per_unit = 1;
        file_.layers = {"floors", "cubes"};
        file_.pairs = {
            {.asked = {.a = 0, .b = 1, .effects = Ask::response | Ask::within, .tolerance = 1e-3}},
            {.asked = {.a = 1, .b = 1, .effects = Ask::response}}};
        file_.models = {"floor.obj", "cube.obj"};
        file_.motions = {Motion::fixed({}),
                         Motion::fixed(*Pose::from_quaternion(1, 0, 0, 0, {0, 0, height}))};
        file_.dynamics.gravity = Double3{0, 0, -8};
        file_.bodies = {{}};
        file_.objects = {{.name = "floor", .model = 0, .layer = 0, .motion = 0},
                         {.name = "cube", .model = 1, .layer = 1, .motion = 1, .body = 0}};
        models_.resize(2);
        models_[0].model.emplace(std::move(floor_.model));
        models_[1].model.emplace(std::move(cube_.model));
    }
    SceneFile& file() {
        return file_;
    }
    std::vector<SceneModel>& models() {
        return models_;
    }
    [[nodiscard]] Simulation make(BodyPoses poses = BodyPoses::computed,
                                  std::uint32_t threads = 1) const {
        auto made = Simulation::make(file_, models_, threads, test::run_threads, poses);
        if (!made) ADD_FAILURE() << made.error().message;
        return std::move(made).value();
    }

private:
    study::MemoryModel floor_ = baked(test::moved_by(test::unit_cube(), 8, {-4, -4, -8}));
    study::MemoryModel cube_ = baked(test::moved_by(test::unit_cube(), 1, {-0.5, -0.5, -0.5}));
    SceneFile file_;
    std::vector<SceneModel> models_;
};

class ResponseTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!dynamics::has_dynamics()) GTEST_SKIP() << "built without Bullet";
    }
};

Double3 place_of(const Simulation& simulation, std::size_t slot) {
    return simulation.poses()[slot].translation();
}

// By hand: the parabola. Velocities are floats.
TEST_F(ResponseTest, BodiesFallFreely) {
    Falling falling(100);
    falling.file().bodies[0].velocity = {1, 0, 2};
    Simulation simulation = falling.make();
    for (std::uint64_t frame = 0; frame <= 60; ++frame) {
        ASSERT_TRUE(simulation.step(frame));
        const double t = static_cast<double>(frame) / 60;
        const Double3 p = place_of(simulation, 1);
        EXPECT_NEAR(p.x, t, 1e-5);
        EXPECT_NEAR(p.y, 0, 1e-12);
        EXPECT_NEAR(p.z, 100 + 2 * t - 4 * t * t, 1e-4);
    }
    EXPECT_EQ(simulation.response()->bodies().mass(1), 1000) << "water, by the volume";
}

// The other effects see the bodies where they are.
TEST_F(ResponseTest, BodiesComeToRestAndEventsTell) {
    const Falling falling(1);
    Simulation simulation = falling.make();
    std::vector<std::uint64_t> begins;
    for (std::uint64_t frame = 0; frame < 240; ++frame) {
        ASSERT_TRUE(simulation.step(frame));
        for (const SceneEvent& event : simulation.scene().events()) {
            if (event.kind == EventKind::begins) begins.push_back(frame);
        }
    }
    ASSERT_FALSE(begins.empty());
    // By hand: half a metre takes sqrt(2 * 0.5 / 8) seconds, 21.2 frames.
    EXPECT_NEAR(static_cast<double>(begins.front()), 21.7, 1);
    EXPECT_NEAR(place_of(simulation, 1).z, 0.5, 1e-3);
    EXPECT_TRUE(simulation.response()->bodies().is_asleep(1));
}

// A body that rests for two seconds sleeps, and is told once.
TEST_F(ResponseTest, ASleepingBodyIsToldOnce) {
    const Falling falling(0.51);
    Simulation simulation = falling.make();
    std::vector<BodyEvent> events;
    for (std::uint64_t frame = 0; frame < 240; ++frame) {
        ASSERT_TRUE(simulation.step(frame));
        const auto of_frame = simulation.response()->events();
        events.insert(events.end(), of_frame.begin(), of_frame.end());
    }
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].kind, BodyEventKind::sleeps);
    EXPECT_EQ(events[0].body, 1u);
    EXPECT_GT(events[0].time_s, 2);
    EXPECT_LT(events[0].time_s, 3);
}

// By hand: at 32 m/s it needs 2.5 m / (32 m/s), less the little that gravity adds.
TEST_F(ResponseTest, AnImpactHasItsTime) {
    Falling falling(3);
    falling.file().bodies[0].velocity = {0, 0, -32};
    falling.file().bodies[0].is_continuous = true;
    Simulation simulation = falling.make();
    std::vector<BodyEvent> impacts;
    for (std::uint64_t frame = 0; frame < 8; ++frame) {
        ASSERT_TRUE(simulation.step(frame));
        for (const BodyEvent& event : simulation.response()->events()) {
            if (event.kind == BodyEventKind::impact) impacts.push_back(event);
        }
    }
    ASSERT_FALSE(impacts.empty());
    EXPECT_EQ(impacts[0].body, 1u);
    EXPECT_EQ(impacts[0].other, 0u);
    EXPECT_NEAR(impacts[0].time_s, 2.5 / 32, 2e-3);
}

// Poses that were kept give the same results, on other threads too.
TEST_F(ResponseTest, GivenPosesGiveTheSameResults) {
    const Falling falling(0.75);
    Simulation computed = falling.make();
    Simulation given = falling.make(BodyPoses::given, 2);
    EXPECT_EQ(given.response(), nullptr);
    for (std::uint64_t frame = 0; frame < 90; ++frame) {
        ASSERT_TRUE(computed.step(frame));
        ASSERT_TRUE(given.step(frame, computed.response()->poses()));
        EXPECT_EQ(computed.scene().state_hash(), given.scene().state_hash()) << frame;
    }
    EXPECT_LT(place_of(given, 1).z, 0.6) << "the cube has fallen";
}

// By hand: the wall comes 1 m/s fast to a cube without gravity, half a metre away.
TEST_F(ResponseTest, ObjectsWithAMotionPush) {
    Falling falling(0);
    falling.file().dynamics.gravity = Double3{};
    falling.file().motions[0] =
        Motion::steady(*Pose::from_quaternion(1, 0, 0, 0, {-5, 0, 4}), {1, 0, 0}, {});
    Simulation simulation = falling.make();
    EXPECT_EQ(simulation.response()->driven_count(), 1u);
    for (std::uint64_t frame = 0; frame <= 60; ++frame) ASSERT_TRUE(simulation.step(frame));
    EXPECT_EQ(place_of(simulation, 0).x, -4);
    EXPECT_NEAR(place_of(simulation, 1).x, 0.5, 2e-3) << "it is pushed from then on";
}

// By the definition: begins and ends are the differences of the pairs of two frames. The cube
// bounces in one frame, and rests at last.
TEST_F(ResponseTest, PushesBeginAndEnd) {
    Falling falling(0.6);
    falling.file().dynamics.substeps = 1;
    falling.file().objects[1].material.restitution = 0.5;
    Simulation simulation = falling.make();
    std::vector<ObjectPair> before;
    std::vector<EventKind> kinds;
    for (std::uint64_t frame = 0; frame <= 120; ++frame) {
        ASSERT_TRUE(simulation.step(frame));
        const auto pushing = simulation.response()->pushing();
        std::vector<ObjectPair> now;
        for (const PushEvent& event : simulation.response()->push_events()) {
            EXPECT_EQ(event.pair, (ObjectPair{0, 1}));
            const bool was = std::ranges::binary_search(before, event.pair);
            EXPECT_EQ(event.kind != EventKind::begins, was) << frame;
            if (event.kind != EventKind::ends) now.push_back(event.pair);
            if (event.kind != EventKind::stays) kinds.push_back(event.kind);
        }
        EXPECT_TRUE(std::ranges::equal(now, pushing)) << frame;
        before = now;
    }
    ASSERT_GE(kinds.size(), 3u);
    EXPECT_EQ(kinds[1], EventKind::ends);
    EXPECT_EQ(kinds.back(), EventKind::begins);
}

// Only what the pair of layers asks for; a cube that rests goes on to push, asleep or not.
TEST_F(ResponseTest, ReportsTellPushes) {
    for (const bool tells : {false, true}) {
        Falling falling(0.51);
        falling.file().pairs[0].tells_begins = tells;
        falling.file().pairs[0].asked.tolerance = 0;
        Simulation simulation = falling.make();
        report::SimulationReport report(falling.file(), simulation.plan(),
                                        report::EventFormat::ndjson, 240);
        std::string text;
        for (std::uint64_t frame = 0; frame < 240; ++frame) {
            ASSERT_TRUE(simulation.step(frame));
            text += report.add_frame(frame, simulation);
        }
        EXPECT_TRUE(simulation.response()->bodies().is_asleep(1));
        EXPECT_EQ(simulation.response()->pushing().size(), 1u);
        const std::string pair = R"("effect":"response","a":"floor","b":"cube"})";
        EXPECT_EQ(text.find(R"("event":"begins",)" + pair) != std::string::npos, tells) << text;
        EXPECT_EQ(text.find(R"("event":"stays",)" + pair), std::string::npos);
        const std::string last = text.substr(0, text.rfind(pair));
        EXPECT_EQ(last.ends_with(R"("event":"begins",)"), tells) << text;
    }
}

/// Returns the text about one frame.
std::string text_of(const Falling& falling, const SceneFile& file) {
    Simulation simulation = falling.make();
    report::SimulationReport report(file, simulation.plan(), report::EventFormat::text, 1);
    EXPECT_TRUE(simulation.step(0));
    static_cast<void>(report.add_frame(0, simulation));
    return report.finish(simulation);
}

// A cube without mass properties in its file, though it is closed.
TEST_F(ResponseTest, ReportsTellWhichBodiesResistAsBoxes) {
    constexpr const char* kTold =
        "1 body has the inertia of its box: its file has no usable mass properties";
    Falling falling(1);
    falling.file().bodies[0].mass = 3;
    EXPECT_EQ(text_of(falling, falling.file()).find(kTold), std::string::npos);
    auto plain = study::make_memory_model(
        test::mesh_of(test::moved_by(test::unit_cube(), 1, {-0.5, -0.5, -0.5})), {.pieces = true});
    ASSERT_TRUE(plain);
    falling.models()[1].model.emplace(std::move(plain->model));
    EXPECT_NE(text_of(falling, falling.file()).find(kTold), std::string::npos);
}

// By hand: the cube rests on the floor; nobody asks for contacts, so those that push are shown.
TEST_F(ResponseTest, PagesShowWhatPushes) {
    Falling falling(0.6);
    falling.file().dynamics.sleeps = false;
    falling.file().pairs[0].asked.tolerance = 0;
    Simulation simulation = falling.make();
    report::SceneFrames frames(falling.file(), 61, {});
    for (std::uint64_t frame = 0; frame <= 60; ++frame) {
        ASSERT_TRUE(simulation.step(frame));
        ASSERT_TRUE(frames.add(frame, simulation));
    }
    EXPECT_TRUE(frames.frames().front().hits.empty()) << "it still falls";
    const report::ShownFrame& last = frames.frames().back();
    ASSERT_EQ(last.hits.size(), 1u) << "half a millimetre apart, so within does not hold";
    EXPECT_EQ(last.hits[0].a, 0u);
    EXPECT_EQ(last.hits[0].b, 1u);
    EXPECT_EQ(last.hits[0].effects, 1u << kSceneEffects.size());
    EXPECT_EQ(last.contacts.size(), 4u) << "the corners";
    EXPECT_EQ(last.bodies->awake, 1u);
    EXPECT_EQ(last.bodies->calls, 4u) << "one pair in each substep";
}

// Layers that do not respond pass through each other.
TEST_F(ResponseTest, OnlyPairsOfLayersThatAskPushEachOther) {
    Falling falling(1);
    falling.file().pairs[0].asked.effects = Ask::within;
    Simulation simulation = falling.make();
    for (std::uint64_t frame = 0; frame <= 60; ++frame) ASSERT_TRUE(simulation.step(frame));
    EXPECT_NEAR(place_of(simulation, 1).z, -3, 1e-4) << "it falls as in a void";
}

// By hand: half a millimetre, two metres per second, water; and a tenth more than they need.
TEST(DynamicsOptionsOf, AScene) {
    SceneFile scene;
    scene.metres_per_unit = 0.001;
    scene.step_s = 0.5;
    scene.pairs = {{.asked = {.a = 3, .b = 4, .effects = Ask::response | Ask::collide}},
                   {.asked = {.a = 4, .b = 4, .effects = Ask::collide}}};
    dynamics::DynamicsOptions options = dynamics_options_of(scene);
    EXPECT_DOUBLE_EQ(options.rest_gap, 0.5);
    EXPECT_DOUBLE_EQ(options.most_speed, 2000);
    EXPECT_DOUBLE_EQ(options.tolerance, 1.1 * (0.5 + 2000 * 0.5 / 4));
    EXPECT_DOUBLE_EQ(options.sleep_speed, 10);
    EXPECT_EQ(options.groups, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{3, 4}}));
    scene.dynamics.rest_gap = 0.25;
    scene.dynamics.tolerance = 9;
    options = dynamics_options_of(scene);
    EXPECT_EQ(options.rest_gap, 0.25);
    EXPECT_EQ(options.tolerance, 9);
}

// All reasons at once: numbers and mass. A model that lacks sections is told elsewhere, once.
TEST_F(ResponseTest, RefusalsAreListed) {
    Falling falling(1);
    EXPECT_TRUE(response_refusals(falling.file(), falling.models()).empty());
    study::MemoryModel plain = baked(test::unit_cube(), false);
    falling.models()[0].model.emplace(std::move(plain.model));
    falling.models()[0].needs.asks = Ask::contacts;
    test::TestMesh sheet = test::unit_cube();
    sheet.triangles.resize(10);
    study::MemoryModel open = baked(sheet, false);
    falling.models()[1].model.emplace(std::move(open.model));
    falling.models()[1].needs.asks = Ask::contacts | Ask::response;
    falling.file().dynamics.tolerance = 1e-6;
    const std::vector<std::string> refusals = response_refusals(falling.file(), falling.models());
    ASSERT_EQ(refusals.size(), 1u) << ::testing::PrintToString(refusals);
    EXPECT_EQ(refusals[0].find("s.json: response: The contact tolerance is 1e-06"), 0u);
    EXPECT_EQ(model_refusals(falling.file(), falling.models()).size(), 2u) << "one for each model";
    // The mesh is unbalanced, and no bake of it has mass.
    study::MemoryModel whole =
        study::make_memory_model(test::mesh_of(sheet), {.pieces = true}).value();
    falling.models()[1].model.emplace(std::move(whole.model));
    EXPECT_EQ(model_refusals(falling.file(), falling.models()).size(), 1u);
    const std::vector<std::string> more = response_refusals(falling.file(), falling.models());
    ASSERT_EQ(more.size(), 2u) << ::testing::PrintToString(more);
    EXPECT_EQ(
        more[1].find("s.json: object 'cube': response needs mass, and the mesh is unbalanced"), 0u);
    falling.file().pairs[0].asked.effects = falling.file().pairs[1].asked.effects = Ask::within;
    EXPECT_TRUE(response_refusals(falling.file(), falling.models()).empty()) << "nobody asks";
}

}  // namespace
}  // namespace cdprep::scenes
