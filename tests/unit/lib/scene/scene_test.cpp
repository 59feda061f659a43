// SPDX-License-Identifier: MIT
#include "cdprep/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

#include "cdprep/advanced/runtime_model.h"
#include "support/aligned_bytes.h"
#include "support/float_modes.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/run_threads.h"
#include "support/same_distance.h"

namespace cdprep {
namespace {

constexpr double kReach = 4;  ///< of poses, in sizes of a model

// Layers: 0 and 1 collide, 1 and 2 as solids, 2 and 2 have a tolerance and a distance, 0 and 2
// nothing.
const std::vector<LayerPair> kPairs = {
    {.a = 0, .b = 1, .effects = Ask::collide},
    {.a = 2, .b = 1, .effects = Ask::collide, .body = Body::solid},
    {.a = 2, .b = 2, .effects = Ask::within | Ask::distance, .tolerance = 0.1, .max_distance = 1}};

Plan plan_for(std::uint32_t objects, std::uint32_t pairs, std::uint32_t threads = 1) {
    return *Plan::compile({.pairs = kPairs,
                           .limits = {.objects = objects, .pairs = pairs, .threads = threads}})
                .plan;
}

/// An effect that holds for two objects.
using Key = std::tuple<ObjectId, ObjectId, Ask>;

/// Returns the keys that `others` lacks, sorted.
std::vector<Key> without(const std::vector<Key>& keys, const std::vector<Key>& others) {
    std::vector<Key> rest;
    for (const Key& key : keys) {
        if (std::find(others.begin(), others.end(), key) == others.end()) rest.push_back(key);
    }
    std::sort(rest.begin(), rest.end());
    return rest;
}

/// A scene beside a plain list of what is in it.
class World {
public:
    explicit World(std::uint32_t seed, const Plan& plan)
        : random_(seed), plan_(plan), scene_(plan), workspaces_(plan.limits().threads) {
        models_.push_back(test::open_tiny(test::icosphere(2)));
        models_.push_back(test::open_tiny(test::torus(0.7, 0.2, 12, 8)));
        models_.push_back(test::open_tiny(test::moved_by(test::unit_cube(), 0.5, {0, 0, 0})));
    }
    std::uint32_t any(std::uint32_t below) {
        return static_cast<std::uint32_t>(random_() % below);
    }
    void add() {
        const SceneObject object = {&models_[any(3)].model, any(3),
                                    test::random_pose(random_, kReach)};
        const auto id = scene_.add(object);
        ASSERT_EQ(id.has_value(), objects_.size() < plan_.limits().objects);
        if (id) objects_[*id] = object;
    }
    void change_one() {
        if (objects_.empty()) return;
        const auto at =
            std::next(objects_.begin(), any(static_cast<std::uint32_t>(objects_.size())));
        switch (any(8)) {
            case 0:
                EXPECT_TRUE(scene_.remove(at->first));
                EXPECT_FALSE(scene_.remove(at->first));
                objects_.erase(at);
                break;
            case 1:
                at->second.layer = any(3);
                EXPECT_TRUE(scene_.set_layer(at->first, at->second.layer));
                break;
            default:
                at->second.world_from_model = test::random_pose(random_, kReach);
                EXPECT_TRUE(scene_.set_pose(at->first, at->second.world_from_model));
        }
    }
    SceneStep step() {
        return scene_.step(workspaces_, test::run_threads);
    }
    Scene& scene() {
        return scene_;
    }
    [[nodiscard]] std::size_t size() const {
        return objects_.size();
    }

    /// Expects what single queries of all pairs answer. Returns what holds.
    std::vector<Key> expect_single_answers() {
        std::vector<Key> holding;
        std::size_t hits = 0, distances = 0;
        for (auto a = objects_.begin(); a != objects_.end(); ++a) {
            for (auto b = std::next(a); b != objects_.end(); ++b) {
                const auto number = plan_.find_pair(a->second.layer, b->second.layer);
                if (!number) continue;
                const LayerPair& asks = plan_.pairs()[*number];
                const Pair pair{
                    *a->second.model,
                    *b->second.model,
                    Placement::world(a->second.world_from_model, b->second.world_from_model),
                    {.body = asks.body}};
                Ask holds = Ask::nothing;
                if (contains(asks.effects, Ask::collide) &&
                    collide(pair, workspace_).hit == Answer::yes) {
                    holds = holds | Ask::collide;
                }
                if (contains(asks.effects, Ask::within) &&
                    within(pair, asks.tolerance, workspace_)) {
                    holds = holds | Ask::within;
                }
                if (contains(asks.effects, Ask::distance)) {
                    const auto found =
                        distance(pair, workspace_, {.max_distance = asks.max_distance});
                    if (found) {
                        holds = holds | Ask::distance;
                        const auto stream = scene_.distances();
                        EXPECT_LT(distances, stream.size());
                        if (distances == stream.size()) return holding;
                        EXPECT_EQ(stream[distances].a, a->first);
                        EXPECT_EQ(stream[distances].b, b->first);
                        test::expect_same(stream[distances].distance, found);
                        ++distances;
                    }
                }
                for (const Ask one : {Ask::collide, Ask::within, Ask::distance}) {
                    if (contains(holds, one)) holding.emplace_back(a->first, b->first, one);
                }
                if (holds == Ask::nothing) continue;
                const auto stream = scene_.hits();
                EXPECT_LT(hits, stream.size());
                if (hits == stream.size()) return holding;
                EXPECT_EQ(stream[hits].a, a->first);
                EXPECT_EQ(stream[hits].b, b->first);
                EXPECT_EQ(stream[hits].pair, *number);
                EXPECT_EQ(stream[hits].holds, holds);
                ++hits;
            }
        }
        EXPECT_EQ(hits, scene_.hits().size());
        EXPECT_EQ(distances, scene_.distances().size());
        return holding;
    }

private:
    std::mt19937 random_;
    const Plan& plan_;
    std::vector<test::OpenModel> models_;
    std::map<ObjectId, SceneObject> objects_;
    Scene scene_;
    std::vector<Workspace> workspaces_;
    Workspace workspace_;
};

// Single queries of all pairs are the oracle, and the difference of two steps that of events.
TEST(Scene, EqualsSingleQueriesAndTheirDifferences) {
    std::size_t begun = 0, kept = 0, apart = 0;
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const Plan plan = plan_for(24, 300);
        World world(seed, plan);
        for (int i = 0; i < 20; ++i) world.add();
        std::vector<Key> held;
        for (int step = 0; step < 12; ++step) {
            ASSERT_TRUE(world.step().complete);
            const std::vector<Key> holding = world.expect_single_answers();
            if (HasFailure()) return;
            std::vector<Key> begins, ends;
            for (const SceneEvent& event : world.scene().events()) {
                (event.begins ? begins : ends).emplace_back(event.a, event.b, event.effect);
            }
            // A change of the layer may also end an effect and begin it again.
            ASSERT_EQ(without(begins, ends), without(holding, held));
            ASSERT_EQ(without(ends, begins), without(held, holding));
            begun += begins.size();
            kept += world.scene().counts().kept;
            apart += world.scene().counts().apart;
            held = holding;
            const std::uint32_t changes = world.any(6);
            for (std::uint32_t i = 0; i < changes; ++i) world.change_one();
            if (world.any(3) == 0) world.add();
        }
    }
    EXPECT_GT(begun, 100U);
    EXPECT_GT(kept, 100U);
    EXPECT_GT(apart, 10U);
}

TEST(Scene, ThreadsGiveTheSame) {
    const Plan one = plan_for(60, 2000, 1), many = plan_for(60, 2000, 8);
    World a(5, one), b(5, many);
    for (int i = 0; i < 60; ++i) {
        a.add();
        b.add();
    }
    for (int step = 0; step < 10; ++step) {
        ASSERT_TRUE(a.step().complete);
        ASSERT_TRUE(b.step().complete);
        ASSERT_EQ(a.scene().state_hash(), b.scene().state_hash());
        ASSERT_GT(a.scene().hits().size(), 10U);
        for (int i = 0; i < 10; ++i) {
            a.change_one();
            b.change_one();
        }
    }
}

TEST(Scene, AStepWithoutChangesAsksNothing) {
    const Plan plan = plan_for(30, 500);
    World world(7, plan);
    for (int i = 0; i < 30; ++i) world.add();
    ASSERT_TRUE(world.step().complete);
    const std::size_t hits = world.scene().hits().size();
    EXPECT_GT(hits, 0U);
    EXPECT_GT(world.scene().counts().collide, 0U);
    ASSERT_TRUE(world.step().complete);
    EXPECT_EQ(world.scene().hits().size(), hits);
    EXPECT_TRUE(world.scene().events().empty());
    const SceneCounts& counts = world.scene().counts();
    EXPECT_EQ(counts.kept, counts.candidates);
    EXPECT_EQ(counts.collide + counts.within + counts.distance, 0U);
}

TEST(Scene, SaysHowManyPairsAreNeededAndChangesNothing) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    const Plan plan = plan_for(10, 8);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    std::vector<ObjectId> objects;
    for (std::uint32_t i = 0; i < 10; ++i) {
        const Pose pose = Pose::from_quaternion(1, 0, 0, 0, {3.0 * i, 0, 0}).value();
        objects.push_back(*scene.add({&ball.model, i % 2, pose}));
    }
    EXPECT_FALSE(scene.add({&ball.model, 0, Pose()}));
    ASSERT_TRUE(scene.set_pose(objects[1], Pose()));
    ASSERT_TRUE(scene.step(workspaces).complete);
    ASSERT_EQ(scene.hits().size(), 1U);
    for (const ObjectId object : objects) ASSERT_TRUE(scene.set_pose(object, Pose()));
    for (int repeat = 0; repeat < 2; ++repeat) {
        const SceneStep step = scene.step(workspaces);
        EXPECT_FALSE(step.complete);
        EXPECT_EQ(step.needed_pairs, 25U);
        EXPECT_EQ(scene.hits().size(), 1U);
        EXPECT_EQ(scene.events().size(), 1U);
    }
    for (std::uint32_t i = 2; i < 10; ++i) ASSERT_TRUE(scene.remove(objects[i]));
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_EQ(scene.hits().size(), 1U);
    EXPECT_TRUE(scene.events().empty());
}

TEST(Scene, EventsSayWhy) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    const Plan plan = plan_for(4, 10);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    const ObjectId a = *scene.add({&ball.model, 0, Pose()});
    const ObjectId b = *scene.add({&ball.model, 1, Pose()});
    const auto events = [&] {
        EXPECT_TRUE(scene.step(workspaces).complete);
        std::vector<std::pair<bool, EventReason>> found;
        for (const SceneEvent& event : scene.events()) {
            found.emplace_back(event.begins, event.reason);
        }
        return found;
    };
    using Expected = std::vector<std::pair<bool, EventReason>>;
    EXPECT_EQ(events(), (Expected{{true, EventReason::moved}}));
    ASSERT_TRUE(scene.set_layer(a, 2));  // now as solids
    EXPECT_EQ(events(),
              (Expected{{false, EventReason::relayered}, {true, EventReason::relayered}}));
    ASSERT_TRUE(scene.set_pose(b, Pose::from_quaternion(1, 0, 0, 0, {9, 0, 0}).value()));
    EXPECT_EQ(events(), (Expected{{false, EventReason::moved}}));
    ASSERT_TRUE(scene.set_pose(b, Pose()));
    EXPECT_EQ(events(), (Expected{{true, EventReason::moved}}));
    ASSERT_TRUE(scene.remove(b));
    const ObjectId c = *scene.add({&ball.model, 1, Pose()});
    EXPECT_EQ(c.slot, b.slot);
    EXPECT_NE(c.generation, b.generation);
    EXPECT_EQ(events(), (Expected{{false, EventReason::removed}, {true, EventReason::moved}}));
    EXPECT_FALSE(scene.set_pose(b, Pose()));
    EXPECT_FALSE(scene.set_layer(b, 0));
    EXPECT_FALSE(scene.remove({99, 1}));
    EXPECT_FALSE(scene.remove({}));
}

TEST(Scene, FloatModesChangeNothing) {
    const Plan plan = plan_for(40, 600, 2);
    const test::OpenModel ring = test::open_tiny(test::torus(0.7, 0.2, 12, 8));
    std::mt19937 random(9);
    std::vector<Pose> poses;
    for (int i = 0; i < 120; ++i) poses.push_back(test::random_pose(random, 2));
    std::vector<std::uint64_t> hashes;
    for (const test::FloatMode& mode : test::float_modes()) {
        Scene scene(plan);
        std::vector<Workspace> workspaces(2);
        std::vector<ObjectId> objects;
        const std::uint64_t left = test::run_in(mode, [&] {
            for (std::uint32_t i = 0; i < 40; ++i) {
                objects.push_back(*scene.add({&ring.model, i % 3, poses[i]}));
            }
            for (std::size_t step = 0; step < 3; ++step) {
                for (std::size_t i = 0; i < 40; ++i) {
                    static_cast<void>(scene.set_pose(objects[i], poses[40 * step + i]));
                }
                static_cast<void>(scene.step(workspaces, test::run_threads));
                hashes.push_back(scene.state_hash());
                hashes.push_back(scene.counts().apart);
            }
        });
        EXPECT_EQ(left, test::control_bits(mode.control)) << mode.name;
        EXPECT_GT(scene.hits().size(), 20U);
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_EQ(hashes[hashes.size() - 6 + i], hashes[i]) << mode.name;
        }
    }
}

// The greatest numbers that a plan accepts reach everything.
TEST(Scene, TakesAnyDistance) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    constexpr double kMost = std::numeric_limits<double>::max();
    for (const double limit : {kMost, 0x1p1000}) {
        const std::vector<LayerPair> pairs = {
            {.effects = Ask::distance | Ask::within, .tolerance = limit, .max_distance = limit}};
        const Plan plan =
            *Plan::compile({.pairs = pairs, .limits = {.objects = 3, .pairs = 9}}).plan;
        Scene scene(plan);
        std::vector<Workspace> workspaces(1);
        for (const double x : {0.0, 1e30, -1e200}) {
            const Pose pose = Pose::from_quaternion(1, 0, 0, 0, {x, 0, 0}).value();
            ASSERT_TRUE(scene.add({&ball.model, 0, pose}));
        }
        ASSERT_TRUE(scene.step(workspaces).complete);
        EXPECT_EQ(scene.hits().size(), 3U);
        EXPECT_EQ(scene.distances().size(), 3U);
    }
}

// The vertices change, the pose does not: set_pose() says so.
TEST(Scene, SeesModelsThatWereRefitted) {
    const test::TestMesh mesh = test::icosphere(1);
    const auto arrays =
        build::build_model(mesh.positions, mesh.triangles, {.bounds = build::BvhBounds::aligned});
    test::AlignedBytes room(build::RuntimeModel::bytes(arrays.value()).value());
    auto object = build::RuntimeModel::in(room.span(), arrays.value());
    ASSERT_TRUE(object);
    const test::OpenModel ball = test::open_tiny(mesh);
    const Plan plan = plan_for(2, 4);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    const Pose far = Pose::from_quaternion(1, 0, 0, 0, {5, 0, 0}).value();
    ASSERT_TRUE(scene.add({&ball.model, 0, far}));
    const ObjectId moving = *scene.add({&object.value().model(), 1, Pose()});
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_TRUE(scene.hits().empty());
    std::vector<Double3> positions = mesh.positions;
    for (Double3& p : positions) p.x += 4;
    ASSERT_TRUE(object.value().refit(positions));
    ASSERT_TRUE(scene.set_pose(moving, Pose()));
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_EQ(scene.hits().size(), 1U);
}

TEST(Scene, LivesInMemoryOfTheCaller) {
    const Plan plan = plan_for(5, 20);
    const std::size_t size = Scene::size(plan), alignment = Scene::alignment();
    std::vector<std::byte> room(size + 2 * alignment);
    void* at = room.data();
    std::size_t space = room.size();
    auto* const memory = static_cast<std::byte*>(std::align(alignment, size, at, space));
    EXPECT_FALSE(Scene::in_memory({memory, size - 1}, plan));
    EXPECT_FALSE(Scene::in_memory({memory + 8, size}, plan));
    auto scene = Scene::in_memory({memory, size}, plan);
    ASSERT_TRUE(scene);
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    std::vector<Workspace> workspaces(1);
    ASSERT_TRUE(scene->add({&ball.model, 0, Pose()}));
    ASSERT_TRUE(scene->add({&ball.model, 1, Pose()}));
    Scene moved = std::move(*scene);
    ASSERT_TRUE(moved.step(workspaces).complete);
    EXPECT_EQ(moved.hits().size(), 1U);
    EXPECT_EQ(moved.object_count(), 2U);
}

TEST(SceneDeathTest, StopsOnMisuse) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    const Plan plan = plan_for(5, 20);
    Scene scene(plan);
    std::vector<Workspace> none;
    EXPECT_DEATH((void)scene.step(none), "needs a workspace");
    EXPECT_DEATH((void)scene.add({nullptr, 0, Pose()}), "needs a model");
    EXPECT_DEATH((void)scene.add({&ball.model, 32, Pose()}), "32 layers");
}

}  // namespace
}  // namespace cdprep
