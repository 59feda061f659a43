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

#include "cdprep/live_model.h"
#include "scene/scene_state.h"
#include "support/aligned_bytes.h"
#include "support/float_modes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/rounds.h"
#include "support/run_threads.h"
#include "support/same_contacts.h"
#include "support/same_distance.h"

namespace cdprep {
namespace {

constexpr double kReach = 4;  ///< of poses, in sizes of a model

// Each effect alone and with those that tell its answer, of surfaces and of solids. Layers 0 and 2
// are not paired.
const std::vector<LayerPair> kPairs = {
    {.a = 0,
     .b = 1,
     .effects = Ask::collide | Ask::overlap,
     .overlap = Overlap::proper,
     .lists_stays = true},
    {.a = 2,
     .b = 1,
     .effects = Ask::collide | Ask::contacts,
     .body = Body::solid,
     .contacts = {.tolerance = 0.05, .manifold = Manifold::four, .most = 5}},
    {.a = 2, .b = 2, .effects = Ask::within | Ask::distance, .tolerance = 0.1, .max_distance = 1},
    {.a = 1,
     .b = 1,
     .effects = Ask::collide | Ask::within | Ask::distance,
     .tolerance = 0.3,
     .max_distance = 0.2,
     .body = Body::solid},
    {.a = 0,
     .b = 0,
     .effects = Ask::collide | Ask::overlap | Ask::within | Ask::distance | Ask::contacts,
     .tolerance = 0.1,
     .max_distance = 0.2,
     .contacts = {.most = 3, .work = 100, .cluster_angle = 0.2}}};

/// Effects that the smallest files serve.
const std::vector<LayerPair> kPlainPairs = {
    {.a = 0, .b = 1, .effects = Ask::collide},
    {.a = 2, .b = 1, .effects = Ask::collide, .body = Body::solid},
    {.a = 2, .b = 2, .effects = Ask::within | Ask::distance, .tolerance = 0.1, .max_distance = 1}};

Plan plain_plan(std::uint32_t objects, std::uint32_t pairs, std::uint32_t threads = 1) {
    return *Plan::compile({.pairs = kPlainPairs,
                           .limits = {.objects = objects, .pairs = pairs, .threads = threads}})
                .plan;
}

Plan plan_for(std::uint32_t objects, std::uint32_t pairs, std::uint32_t threads = 1) {
    return *Plan::compile({.pairs = kPairs,
                           .limits = {.objects = objects,
                                      .pairs = pairs,
                                      .threads = threads,
                                      .triangle_pairs = 100000,
                                      .contacts = 5000}})
                .plan;
}

test::OpenModel open_with_pieces(const test::TestMesh& mesh) {
    return test::open_tiny(
        test::with_contacts(test::with_pieces(test::bake_tiny(mesh.positions, mesh.triangles))));
}

test::OpenModel open_convex(const test::TestMesh& mesh) {
    return test::open_tiny(
        test::with_contacts(test::with_one_piece(test::bake_tiny(mesh.positions, mesh.triangles))));
}

/// Takes the result of two objects from a stream; null if the next one is of others.
template <class Result>
const Result* take(std::span<const Result>& stream, const ObjectId& a, const ObjectId& b) {
    if (stream.empty() || stream.front().a != a || stream.front().b != b) return nullptr;
    const Result* const found = stream.data();
    stream = stream.subspan(1);
    return found;
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
        models_.push_back(open_convex(test::icosphere(2)));
        models_.push_back(open_with_pieces(test::torus(0.7, 0.2, 12, 8)));
        models_.push_back(open_convex(test::moved_by(test::unit_cube(), 0.5, {0, 0, 0})));
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
        streams_ = {scene_.hits(), scene_.overlaps(), scene_.distances(), scene_.contacts()};
        for (auto a = objects_.begin(); a != objects_.end(); ++a) {
            for (auto b = std::next(a); b != objects_.end(); ++b) {
                const auto number = plan_.find_pair(a->second.layer, b->second.layer);
                if (!number) continue;
                const Ask holds = expect_single_answers(*a, *b, *number);
                for (const Ask one : kSceneEffects) {
                    if (contains(holds, one)) holding.emplace_back(a->first, b->first, one);
                }
            }
        }
        EXPECT_TRUE(streams_.hits.empty());
        EXPECT_TRUE(streams_.overlaps.empty());
        EXPECT_TRUE(streams_.distances.empty());
        EXPECT_TRUE(streams_.contacts.empty());
        return holding;
    }
    void pause(Ask effects) {
        scene_.set_paused(effects);
        paused_ = effects;
    }

private:
    using Entry = std::pair<const ObjectId, SceneObject>;
    struct Streams {
        std::span<const SceneHit> hits;
        std::span<const SceneOverlaps> overlaps;
        std::span<const SceneDistance> distances;
        std::span<const SceneContacts> contacts;
    };

    Ask expect_single_answers(const Entry& a, const Entry& b, std::uint32_t number) {
        const LayerPair& asks = plan_.pairs()[number];
        const Ask effects = cdprep::without(asks.effects, paused_);
        const Pair pair{*a.second.model,
                        *b.second.model,
                        Placement::world(a.second.world_from_model, b.second.world_from_model),
                        {.body = asks.body, .overlap = asks.overlap}};
        Ask holds = Ask::nothing;
        if (contains(effects, Ask::collide) && collide(pair, workspace_).hit == Answer::yes) {
            holds = holds | Ask::collide;
        }
        if (contains(effects, Ask::within) && within(pair, asks.tolerance, workspace_)) {
            holds = holds | Ask::within;
        }
        if (contains(effects, Ask::overlap)) {
            room_.resize(20000);
            room_.resize(overlaps(pair, workspace_, room_));
            const SceneOverlaps* const found = take(streams_.overlaps, a.first, b.first);
            EXPECT_EQ(found != nullptr, !room_.empty());
            if (found) {
                EXPECT_TRUE(std::equal(room_.begin(), room_.end(), found->triangles.begin(),
                                       found->triangles.end()));
                holds = holds | Ask::overlap;
            }
        }
        if (contains(effects, Ask::distance)) {
            const auto expected = distance(pair, workspace_, {.max_distance = asks.max_distance});
            const SceneDistance* const found = take(streams_.distances, a.first, b.first);
            EXPECT_EQ(found != nullptr, expected.has_value());
            if (found && expected) {
                test::expect_same(found->distance, expected);
                holds = holds | Ask::distance;
            }
        }
        if (contains(effects, Ask::contacts)) {
            std::vector<Contact> room(asks.contacts.most);
            const auto verdict = contacts(pair, workspace_, room, asks.contacts);
            if (verdict.count > 0 || !verdict.searched) {
                const SceneContacts* const found = take(streams_.contacts, a.first, b.first);
                EXPECT_TRUE(found);
                if (!found) return holds;
                EXPECT_EQ(found->verdict.found, verdict.found);
                EXPECT_EQ(found->contacts.size(), verdict.count);
                for (std::size_t i = 0; i < std::min(verdict.count, found->contacts.size()); ++i) {
                    test::expect_same(found->contacts[i], room[i]);
                }
            }
            if (verdict.count > 0) holds = holds | Ask::contacts;
        }
        if (holds != Ask::nothing) {
            const SceneHit* const hit = take(streams_.hits, a.first, b.first);
            EXPECT_TRUE(hit);
            if (hit) {
                EXPECT_EQ(hit->pair, number);
                EXPECT_EQ(hit->holds, holds);
            }
        }
        return holds;
    }

    std::mt19937 random_;
    const Plan& plan_;
    std::vector<test::OpenModel> models_;
    std::map<ObjectId, SceneObject> objects_;
    Scene scene_;
    std::vector<Workspace> workspaces_;
    Workspace workspace_;
    Ask paused_ = Ask::nothing;
    Streams streams_;
    std::vector<TrianglePair> room_;
};

// Single queries of all pairs are the oracle, and the difference of two steps that of events.
TEST(Scene, EqualsSingleQueriesAndTheirDifferences) {
    std::size_t begun = 0, kept = 0, apart = 0, stays = 0;
    std::map<Ask, std::size_t> begun_of;
    const std::uint32_t scenes = test::asks_all() ? 1000 : 12;
    for (std::uint32_t seed = 0; seed < scenes; ++seed) {
        const Plan plan = plan_for(24, 300, std::array{1U, 2U, 8U}[seed % 3]);
        World world(seed, plan);
        for (int i = 0; i < 20; ++i) world.add();
        std::vector<Key> held;
        for (int step = 0; step < 12; ++step) {
            ASSERT_TRUE(world.step().complete);
            const std::vector<Key> holding = world.expect_single_answers();
            if (HasFailure()) return;
            std::vector<Key> begins, ends;
            for (const SceneEvent& event : world.scene().events()) {
                const Key key = {event.a, event.b, event.effect};
                if (event.kind == EventKind::begins) begins.push_back(key);
                if (event.kind == EventKind::ends) ends.push_back(key);
                if (event.kind != EventKind::stays) continue;
                ASSERT_TRUE(plan.pairs()[event.pair].lists_stays);
                ASSERT_TRUE(std::count(held.begin(), held.end(), key) > 0 &&
                            std::count(holding.begin(), holding.end(), key) > 0);
                ++stays;
            }
            // A change of the layer may also end an effect and begin it again.
            ASSERT_EQ(without(begins, ends), without(holding, held));
            ASSERT_EQ(without(ends, begins), without(held, holding));
            begun += begins.size();
            for (const Key& key : begins) ++begun_of[std::get<Ask>(key)];
            kept += world.scene().counts().kept;
            apart += world.scene().counts().apart;
            held = holding;
            const std::uint32_t changes = world.any(6);
            for (std::uint32_t i = 0; i < changes; ++i) world.change_one();
            if (world.any(3) == 0) world.add();
            if (world.any(4) == 0) world.pause(static_cast<Ask>(world.any(32)));
        }
    }
    EXPECT_GT(begun, 100U);
    EXPECT_GT(kept, 100U);
    EXPECT_GT(apart, 10U);
    EXPECT_GT(stays, 100U);
    for (const Ask one : kSceneEffects) {
        if (!contains(plan_for(1, 1).effects(), one)) continue;
        EXPECT_GT(begun_of[one], 20U) << find_needs(one)->name;
    }
}

TEST(Scene, ThreadsGiveTheSame) {
    for (const std::uint32_t threads : {2U, 8U}) {
        const Plan one = plan_for(60, 2000, 1), many = plan_for(60, 2000, threads);
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
}

/// The numbers of poses that no library's functions round: they are the same everywhere.
Pose coarse_pose(std::mt19937& random) {
    const auto number = [&] { return (static_cast<double>(random() % 2001) - 1000) / 256; };
    const double w = number(), x = number(), y = number(), z = number();
    const Double3 translation = {number(), number(), number()};
    return Pose::from_quaternion(w == 0 ? 1 : w, x, y, z, translation).value();
}

/// A ball with dents.
test::TestMesh rough_ball(std::mt19937& random) {
    test::TestMesh mesh = test::icosphere(2);
    for (Double3& p : mesh.positions) {
        const double radius = 0.75 + static_cast<double>(random() % 65) / 256;
        p = {radius * p.x, radius * p.y, radius * p.z};
    }
    return mesh;
}

// The constants are the answers of the reference kernels: CDPREP_KERNELS=scalar lib_scene_tests
// --gtest_filter=Scene.StatesAreThoseOfTheReference prints them where they differ. The test runs
// again with each instruction set (tests/unit/lib/CMakeLists.txt). A result that is meant to change
// changes them all.
TEST(Scene, StatesAreThoseOfTheReference) {
    constexpr std::array<std::uint64_t, 4> kStates = {0x41444487c7a90f7f, 0x3366b21589ee29b5,
                                                      0x941471c115ec4022, 0xa616a171d9c721bf};
    std::mt19937 random(31);
    std::vector<test::OpenModel> models;
    models.push_back(open_convex(test::icosphere(2)));
    models.push_back(open_with_pieces(rough_ball(random)));
    models.push_back(open_convex(test::moved_by(test::unit_cube(), 0.5, {0, 0, 0})));
    const Plan plan = plan_for(80, 3000);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    std::vector<ObjectId> objects;
    for (std::uint32_t i = 0; i < 80; ++i) {
        objects.push_back(*scene.add({&models[i % 3].model, i / 3 % 3, coarse_pose(random)}));
    }
    for (const std::uint64_t state : kStates) {
        ASSERT_TRUE(scene.step(workspaces).complete);
        EXPECT_EQ(scene.state_hash(), state) << std::hex << scene.state_hash();
        EXPECT_GT(scene.hits().size(), 50U);
        EXPECT_GT(scene.overlaps().size(), 5U);
        EXPECT_GT(scene.distances().size(), 5U);
        EXPECT_GT(scene.contacts().size(), 5U);
        for (int i = 0; i < 20; ++i) {
            EXPECT_TRUE(scene.set_pose(objects[random() % 80], coarse_pose(random)));
        }
    }
}

bool are_same(const SceneHit& x, const SceneHit& y) {
    const Containment &p = x.collision.containment, &q = y.collision.containment;
    return x.a == y.a && x.b == y.b && x.pair == y.pair && x.holds == y.holds &&
           x.collision.hit == y.collision.hit && p.answer == q.answer && p.winding == q.winding &&
           p.a_inside_b == q.a_inside_b;
}

TEST(Scene, AStepWithoutChangesAsksNothing) {
    const Plan plan = plan_for(30, 500);
    World world(7, plan);
    for (int i = 0; i < 30; ++i) world.add();
    ASSERT_TRUE(world.step().complete);
    const std::vector<SceneHit> hits(world.scene().hits().begin(), world.scene().hits().end());
    EXPECT_GT(hits.size(), 0U);
    EXPECT_GT(world.scene().counts().calls_of(Ask::collide), 0U);
    EXPECT_GT(world.scene().counts().triangle_pairs, 0U);
    const std::uint64_t triangle_pairs = world.scene().counts().triangle_pairs;
    const std::uint64_t contacts = world.scene().counts().contacts;
    ASSERT_TRUE(world.step().complete);
    EXPECT_TRUE(std::ranges::equal(world.scene().hits(), hits, are_same));
    world.expect_single_answers();
    for (const SceneEvent& event : world.scene().events()) {
        EXPECT_EQ(event.kind, EventKind::stays);
        EXPECT_EQ(event.reason, EventReason::unchanged);
    }
    const SceneCounts& counts = world.scene().counts();
    EXPECT_EQ(counts.kept, counts.candidates);
    for (const Ask one : kSceneEffects) EXPECT_EQ(counts.calls_of(one), 0U);
    EXPECT_EQ(counts.triangle_pairs, triangle_pairs);
    EXPECT_EQ(counts.contacts, contacts);
    EXPECT_GT(contacts, 0U);
}

// Lists that do not fit are counted exactly, and the last step stays.
TEST(Scene, SaysHowLongListsAre) {
    const test::OpenModel ball = open_convex(test::icosphere(2));
    const std::vector<LayerPair> pairs = {
        {.effects = Ask::overlap | Ask::contacts, .contacts = {.most = 4}}};
    const auto plan_with = [&](std::uint32_t triangle_pairs, std::uint32_t contacts,
                               std::uint32_t threads) {
        return *Plan::compile({.pairs = pairs,
                               .limits = {.objects = 10,
                                          .pairs = 100,
                                          .threads = threads,
                                          .triangle_pairs = triangle_pairs,
                                          .contacts = contacts}})
                    .plan;
    };
    const auto fill = [&](Scene& scene) {
        for (int i = 0; i < 10; ++i) {
            const Pose pose = Pose::from_quaternion(1, 0, 0, 0, {0.4 * i, 0.01 * i, 0}).value();
            ASSERT_TRUE(scene.add({&ball.model, 0, pose}));
        }
    };
    const Plan large = plan_with(1U << 20, 1000, 1);
    Scene whole(large);
    fill(whole);
    std::vector<Workspace> workspaces(3);
    ASSERT_TRUE(whole.step(workspaces).complete);
    const auto triangle_pairs = static_cast<std::uint32_t>(whole.counts().triangle_pairs);
    const auto contacts = static_cast<std::uint32_t>(whole.counts().contacts);
    ASSERT_GT(triangle_pairs, 2048U);  // more than a page
    ASSERT_GT(contacts, 10U);
    for (const std::uint32_t threads : {1U, 3U}) {
        const Plan exact = plan_with(triangle_pairs, contacts, threads);
        Scene scene(exact);
        fill(scene);
        ASSERT_TRUE(scene.step(workspaces, test::run_threads).complete);
        EXPECT_EQ(scene.state_hash(), whole.state_hash());
        const Plan small = plan_with(triangle_pairs - 1, contacts - 1, threads);
        Scene short_one(small);
        fill(short_one);
        const SceneStep step = short_one.step(workspaces, test::run_threads);
        EXPECT_FALSE(step.complete);
        EXPECT_EQ(step.needed_pairs, 0U);
        EXPECT_EQ(step.needed_triangle_pairs, triangle_pairs);
        EXPECT_EQ(step.needed_contacts, contacts);
        EXPECT_TRUE(short_one.hits().empty());
        ASSERT_TRUE(short_one.remove({9, 1}));
        EXPECT_TRUE(short_one.step(workspaces, test::run_threads).complete);
        EXPECT_FALSE(short_one.hits().empty());
        // What is kept counts as well.
        ASSERT_TRUE(short_one.add({&ball.model, 0, Pose()}));
        EXPECT_GT(short_one.step(workspaces, test::run_threads).needed_triangle_pairs,
                  triangle_pairs);
    }
}

TEST(Scene, PausesEffectsAndResumesThem) {
    const test::OpenModel ball = open_convex(test::icosphere(2));
    const Plan plan = plan_for(4, 10);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    ASSERT_TRUE(scene.add({&ball.model, 0, Pose()}));
    ASSERT_TRUE(scene.add({&ball.model, 0, Pose::from_quaternion(1, 0, 0, 0, {1, 0, 0}).value()}));
    ASSERT_TRUE(scene.step(workspaces).complete);
    const std::size_t all = scene.events().size();
    const std::uint64_t triangle_pairs = scene.counts().triangle_pairs;
    EXPECT_EQ(all, 5U);
    scene.set_paused(Ask::overlap | Ask::ray);
    ASSERT_TRUE(scene.step(workspaces).complete);
    ASSERT_EQ(scene.events().size(), 1U);
    EXPECT_EQ(scene.events()[0].effect, Ask::overlap);
    EXPECT_EQ(scene.events()[0].kind, EventKind::ends);
    EXPECT_EQ(scene.events()[0].reason, EventReason::paused);
    EXPECT_EQ(scene.counts().kept, 1U);
    EXPECT_TRUE(scene.overlaps().empty());
    EXPECT_EQ(scene.counts().triangle_pairs, 0U);
    scene.set_paused(static_cast<Ask>(~0U));
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_EQ(scene.events().size(), all - 1);
    EXPECT_TRUE(scene.hits().empty());
    scene.set_paused(Ask::nothing);
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_EQ(scene.events().size(), all);
    EXPECT_EQ(scene.events()[0].reason, EventReason::paused);
    EXPECT_EQ(scene.counts().triangle_pairs, triangle_pairs);
}

// Any order, pairs that are listed twice, and pairs that are none.
TEST(Scene, TakesCandidatesOfTheCaller) {
    const Plan plan = plan_for(40, 800);
    World mine(3, plan), theirs(3, plan);
    for (int i = 0; i < 30; ++i) {
        mine.add();
        theirs.add();
    }
    std::vector<Workspace> workspaces(1);
    std::mt19937 random(1);
    for (int step = 0; step < 12; ++step) {
        std::vector<BoxPair> candidates;
        const auto boxes = theirs.scene().boxes();
        ASSERT_EQ(boxes.size(), 40U);
        for (std::uint32_t a = 0; a < 41; ++a) {
            for (std::uint32_t b = 0; b < 41; ++b) {
                if (step % 3 == 0 || a <= b) candidates.push_back({a, b});
            }
        }
        std::shuffle(candidates.begin(), candidates.end(), random);
        ASSERT_TRUE(mine.step().complete);
        // Its own broad phase sees what it missed.
        const bool complete = step % 4 == 3
                                  ? theirs.step().complete
                                  : theirs.scene().step_with(candidates, workspaces).complete;
        ASSERT_TRUE(complete);
        ASSERT_EQ(mine.scene().state_hash(), theirs.scene().state_hash()) << step;
        ASSERT_GT(mine.scene().hits().size(), 2U);
        for (int i = 0; i < 6; ++i) {
            mine.change_one();
            theirs.change_one();
        }
    }
    const Plan small = plan_for(40, 3);
    World few(3, small);
    for (int i = 0; i < 30; ++i) few.add();
    std::vector<BoxPair> candidates;
    for (std::uint32_t a = 0; a < 30; ++a) {
        for (std::uint32_t b = 0; b < a; ++b) candidates.push_back({a, b});
    }
    EXPECT_EQ(few.scene().step_with(candidates, workspaces).needed_pairs, few.step().needed_pairs);
}

TEST(Scene, SaysHowManyPairsAreNeededAndChangesNothing) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    const Plan plan = plain_plan(10, 8);
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
    const Plan plan = plain_plan(4, 10);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    const ObjectId a = *scene.add({&ball.model, 0, Pose()});
    const ObjectId b = *scene.add({&ball.model, 1, Pose()});
    const auto events = [&] {
        EXPECT_TRUE(scene.step(workspaces).complete);
        std::vector<std::pair<bool, EventReason>> found;
        for (const SceneEvent& event : scene.events()) {
            found.emplace_back(event.kind == EventKind::begins, event.reason);
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

// An id that was never given must not become valid: 0 means no object.
TEST(Scene, GenerationsLeaveOutZero) {
    EXPECT_EQ(next_generation(0), 1U);
    EXPECT_EQ(next_generation(1), 2U);
    EXPECT_EQ(next_generation(0xffffffff), 1U);
}

TEST(Scene, FloatModesChangeNothing) {
    const Plan plan = plain_plan(40, 600, 2);
    const test::OpenModel ring = test::open_tiny(test::torus(0.7, 0.2, 12, 8));
    std::mt19937 random(9);
    std::vector<Pose> poses;
    poses.reserve(120);
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

/// The slots and candidates of a row of balls, three apart, far from 0.
struct FarRow {
    std::vector<std::array<std::uint32_t, 2>> hits;
    std::uint64_t candidates;
};

FarRow far_row(const Model& ball, const Double3& origin) {
    const std::vector<LayerPair> pairs = {{.effects = Ask::within, .tolerance = 1.25}};
    const Plan plan =
        *Plan::compile({.pairs = pairs, .limits = {.objects = 20, .pairs = 200}, .origin = origin})
             .plan;
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    for (int i = 0; i < 20; ++i) {
        const Double3 at = {1e8 + 3 * i, -1e8, 2e8};
        EXPECT_TRUE(scene.add({&ball, 0, Pose::from_quaternion(1, 0, 0, 0, at).value()}));
    }
    EXPECT_TRUE(scene.step(workspaces).complete);
    FarRow row{{}, scene.counts().candidates};
    for (const SceneHit& hit : scene.hits()) row.hits.push_back({hit.a.slot, hit.b.slot});
    return row;
}

// Boxes in float are wide there, unless they are relative to a point nearby.
TEST(Scene, AnOriginNearbySparesCandidatesAlone) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(3));
    const FarRow far = far_row(ball.model, {}), near = far_row(ball.model, {1e8, -1e8, 2e8});
    EXPECT_EQ(near.candidates, 19U);
    EXPECT_GT(far.candidates, 4 * near.candidates);
    EXPECT_EQ(near.hits.size(), 19U);
    EXPECT_EQ(far.hits, near.hits);
}

// The greatest numbers that a plan accepts reach everything.
TEST(Scene, TakesAnyDistance) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    constexpr double kMost = std::numeric_limits<double>::max();
    for (const double limit : {kMost, 0x1p1000}) {
        const std::vector<LayerPair> pairs = {
            {.effects = Ask::distance | Ask::within, .tolerance = limit, .max_distance = limit}};
        const double far = limit == kMost ? 0x1p1000 : -0x1p1000;
        const Plan plan =
            *Plan::compile(
                 {.pairs = pairs, .limits = {.objects = 3, .pairs = 9}, .origin = {far, -far, far}})
                 .plan;
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
    test::AlignedBytes room(LiveModel::bytes(arrays.value()).value());
    auto object = LiveModel::in(room.span(), arrays.value());
    ASSERT_TRUE(object);
    const test::OpenModel ball = test::open_tiny(mesh);
    const Plan plan = plain_plan(2, 4);
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
    const Plan plan = plain_plan(5, 20);
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
    const Plan plan = plain_plan(5, 20);
    Scene scene(plan);
    std::vector<Workspace> none;
    EXPECT_DEATH((void)scene.step(none), "needs a workspace");
    EXPECT_DEATH((void)scene.add({nullptr, 0, Pose()}), "needs a model");
    EXPECT_DEATH((void)scene.add({&ball.model, 32, Pose()}), "32 layers");
}

}  // namespace
}  // namespace cdprep
