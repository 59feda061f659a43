// SPDX-License-Identifier: MIT
// Effects of scenes that need more than two poses: models that change, motions, and bounded work.
// Single queries are the oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "cdprep/advanced/object_box.h"
#include "cdprep/live_model.h"
#include "cdprep/scene.h"
#include "cdprep/self.h"
#include "support/aligned_bytes.h"
#include "support/float_modes.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/rounds.h"
#include "support/run_threads.h"
#include "support/same_distance.h"
#include "support/slanted_panes.h"

namespace cdprep {
namespace {

constexpr SceneLimits kEffectLimits = {
    .objects = 16, .pairs = 200, .threads = 2, .triangle_pairs = 20000, .contacts = 100};

Plan effects_plan(const std::vector<LayerPair>& pairs, const SceneLimits& limits = kEffectLimits) {
    Plan::Compiled compiled = Plan::compile({.pairs = pairs, .limits = limits});
    for (const std::string& refusal : compiled.refusals) ADD_FAILURE() << refusal;
    return std::move(*compiled.plan);
}

/// A live model in memory of its own.
class Live {
public:
    explicit Live(const test::TestMesh& mesh, const LiveLimits& limits = {})
        : positions(mesh.positions) {
        const auto arrays = build::build_model(mesh.positions, mesh.triangles,
                                               {.bounds = build::BvhBounds::aligned});
        memory_ = test::AlignedBytes(LiveModel::bytes(arrays.value(), limits).value());
        live_.emplace(std::move(LiveModel::in(memory_.span(), arrays.value(), limits)).value());
    }
    [[nodiscard]] const Model& model() const {
        return live_->model();
    }
    LiveModel& operator*() {
        return *live_;
    }
    void refit() {
        EXPECT_TRUE(live_->refit(positions));
    }

    std::vector<Double3> positions;

private:
    test::AlignedBytes memory_{0};
    std::optional<LiveModel> live_;
};

Pose shifted(double x, double y, double z) {
    return *Pose::from_quaternion(1, 0, 0, 0, {x, y, z});
}

/// The motion that a scene describes: about the middle of the model's box.
Motion motion_of(const Model& model, const Pose& start, const Pose& end) {
    const auto middle = root_box(model, Pose(), 0).middle;
    return *Motion::between(start, end, {middle[0], middle[1], middle[2]});
}

/// Objects of one model with a way in each step.
class Movers {
public:
    Movers(std::uint32_t seed, const Plan& plan)
        : random_(seed), scene_(plan), workspaces_(plan.limits().threads) {
        for (std::uint32_t i = 0; i < plan.limits().objects; ++i) {
            const Pose pose = test::random_pose(random_, 5);
            const Model& model = models_[i % 2].model;
            const ObjectId id = *scene_.add({&model, 0, pose});
            objects_.push_back({id, &model, pose, pose});
        }
    }
    void step() {
        ASSERT_TRUE(scene_.step(workspaces_, test::run_threads).complete);
    }
    void move() {
        for (Mover& mover : objects_) {
            mover.start = mover.end;
            const auto choice = random_() % 8;
            if (choice < 3) continue;
            mover.end = test::random_pose(random_, 5);
            if (choice == 3) {
                mover.start = mover.end;
                EXPECT_TRUE(scene_.put(mover.id, mover.end));
            } else {
                EXPECT_TRUE(scene_.set_pose(mover.id, mover.end));
            }
        }
    }
    /// Expects the times of impact of all pairs. Returns how many there are.
    std::size_t expect_impacts() {
        std::span<const SceneImpact> left = scene_.impacts();
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            for (std::size_t j = i + 1; j < objects_.size(); ++j) {
                const Mover &a = objects_[i], &b = objects_[j];
                const Impact expected =
                    time_of_impact({*a.model, *b.model, motion_of(*a.model, a.start, a.end),
                                    motion_of(*b.model, b.start, b.end)},
                                   workspace_, {.tolerance = 0.01});
                if (expected.kind == ImpactKind::none) continue;
                if (left.empty() || left.front().a != a.id || left.front().b != b.id) {
                    ADD_FAILURE() << "an impact of " << i << " and " << j << " is missing";
                    return 0;
                }
                EXPECT_EQ(left.front().impact.kind, expected.kind);
                EXPECT_EQ(left.front().impact.lower, expected.lower);
                EXPECT_EQ(left.front().impact.upper, expected.upper);
                left = left.subspan(1);
            }
        }
        EXPECT_TRUE(left.empty());
        return scene_.impacts().size();
    }
    Scene& scene() {
        return scene_;
    }

private:
    struct Mover {
        ObjectId id;
        const Model* model;
        Pose start, end;
    };
    std::mt19937 random_;
    std::array<test::OpenModel, 2> models_ = {
        test::open_tiny(test::moved_by(test::icosphere(1), 0.5, {0.3, 0, 0})),
        test::open_tiny(test::torus(0.7, 0.2, 12, 8))};
    Scene scene_;
    std::vector<Workspace> workspaces_;
    Workspace workspace_;
    std::vector<Mover> objects_;
};

const std::vector<LayerPair> kContinuous = {
    {.effects = Ask::continuous | Ask::collide, .impact = {.tolerance = 0.01}}};

TEST(SceneContinuous, EqualsSingleQueriesOverWholeWays) {
    const Plan plan = effects_plan(kContinuous);
    std::size_t impacts = 0;
    for (std::uint32_t seed = 0; seed < (test::asks_all() ? 40U : 3U); ++seed) {
        Movers movers(seed, plan);
        for (int step = 0; step < 6; ++step) {
            movers.step();
            impacts += movers.expect_impacts();
            if (HasFailure()) return;
            movers.move();
        }
    }
    EXPECT_GT(impacts, 50U);
}

TEST(SceneContinuous, ThreadsGiveTheSame) {
    SceneLimits limits = kEffectLimits;
    const Plan two = effects_plan(kContinuous, limits);
    limits.threads = 8;
    const Plan eight = effects_plan(kContinuous, limits);
    Movers a(7, two), b(7, eight);
    for (int step = 0; step < 5; ++step) {
        a.step();
        b.step();
        ASSERT_EQ(a.scene().state_hash(), b.scene().state_hash());
        a.move();
        b.move();
    }
}

// By hand: a ball of radius 0.1 flies through a plate from x = -5 to x = 5 in one step.
TEST(SceneContinuous, AFastObjectDoesNotPassThroughUnseen) {
    const test::OpenModel ball =
        test::open_tiny(test::moved_by(test::icosphere(2), 0.1, {0, 0, 0}));
    const test::OpenModel plate =
        test::open_tiny(test::turned(test::moved_by(test::unit_cube(), 1, {0, 0, 0}), 0));
    const std::vector<LayerPair> pairs = {
        {.effects = Ask::continuous | Ask::collide | Ask::within}};
    const Plan plan = effects_plan(pairs);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    const ObjectId fixed = *scene.add({&plate.model, 0, shifted(0, 0, 0)});
    const ObjectId flying = *scene.add({&ball.model, 0, shifted(-5, 0.5, 0.5)});
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_TRUE(scene.hits().empty());
    ASSERT_TRUE(scene.set_pose(flying, shifted(5, 0.5, 0.5)));
    ASSERT_TRUE(scene.step(workspaces).complete);
    ASSERT_EQ(scene.hits().size(), 1U);
    EXPECT_EQ(scene.hits()[0].holds, Ask::continuous);
    ASSERT_EQ(scene.impacts().size(), 1U);
    EXPECT_EQ(scene.impacts()[0].a, fixed);
    EXPECT_NEAR(scene.impacts()[0].impact.lower, 0.49, 1e-3);
    // Where it stands now it touches nothing, and neither did it pass on a way that was none.
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_TRUE(scene.impacts().empty());
    ASSERT_TRUE(scene.put(flying, shifted(-5, 0.5, 0.5)));
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_TRUE(scene.impacts().empty());
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_EQ(scene.counts().kept, scene.counts().candidates);
    EXPECT_EQ(scene.counts().moved, 0U);
}

// A sheet that folds over itself, and a rigid ball.
TEST(SceneSelf, EqualsASingleQueryAndIsKeptWhileTheShapeIs) {
    Live sheet(test::grid_sheet(12, 12));
    const std::vector<LayerPair> pairs = {
        {.effects = Ask::self | Ask::deform | Ask::collide, .lists_stays = true}};
    const Plan plan = effects_plan(pairs);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    Workspace workspace;
    const ObjectId id = *scene.add({&sheet.model(), 0, Pose()});
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    static_cast<void>(scene.add({&ball.model, 0, shifted(50, 0, 0)}));
    const std::vector<Double3> flat = sheet.positions;
    std::vector<TrianglePair> expected(20000);
    bool was_held = false;
    std::size_t held = 0;
    for (int frame = 0; frame < 12; ++frame) {
        const bool is_folded = frame % 3 != 0;
        for (std::size_t i = 0; i < flat.size(); ++i) {
            const double x = is_folded ? 6 - std::abs(flat[i].x - 6) : flat[i].x;
            sheet.positions[i] = {x, flat[i].y, 0.001 * frame};
        }
        sheet.refit();
        ASSERT_TRUE(scene.step(workspaces).complete);
        expected.resize(20000);
        expected.resize(self_overlaps(sheet.model(), workspace, expected));
        const bool holds = !expected.empty();
        ASSERT_EQ(scene.self_overlaps().size(), holds ? 1U : 0U) << frame;
        if (holds) {
            EXPECT_EQ(scene.self_overlaps()[0].object, id);
            EXPECT_TRUE(std::ranges::equal(scene.self_overlaps()[0].triangles, expected));
        }
        EXPECT_EQ(scene.counts().calls_of(Ask::self), frame == 0 ? 2U : 1U);
        std::size_t changes = 0;
        for (const SceneEvent& event : scene.events()) {
            EXPECT_TRUE(event.a == event.b && event.effect == Ask::self);
            changes += event.kind == EventKind::stays ? 0 : 1;
        }
        EXPECT_EQ(changes, holds != was_held ? 1U : 0U);
        was_held = holds;
        held += holds ? 1 : 0;
        // A pose changes nothing about one object.
        ASSERT_TRUE(scene.set_pose(id, shifted(0, 0, frame)));
        ASSERT_TRUE(scene.step(workspaces).complete);
        EXPECT_EQ(scene.counts().calls_of(Ask::self), 0U);
        EXPECT_EQ(scene.self_overlaps().size(), holds ? 1U : 0U);
    }
    EXPECT_EQ(held, 8U);
}

TEST(SceneSelf, SaysHowMuchRoomItNeeds) {
    test::TestMesh crossing =
        test::joined(test::icosphere(1), test::moved_by(test::icosphere(1), 1, {0.5, 0, 0}));
    const test::OpenModel model = test::open_tiny(crossing);
    Workspace workspace;
    const std::size_t pairs_of_one = self_overlaps(model.model, workspace, {});
    ASSERT_GT(pairs_of_one, 5U);
    const std::vector<LayerPair> pairs = {{.effects = Ask::self}};
    std::vector<Workspace> workspaces(1);
    const auto step = [&](std::uint32_t most_pairs, std::uint32_t most_triangles) {
        const Plan plan = effects_plan(
            pairs, {.objects = 3, .pairs = most_pairs, .triangle_pairs = most_triangles});
        Scene scene(plan);
        for (int i = 0; i < 3; ++i) static_cast<void>(scene.add({&model.model, 0, Pose()}));
        const SceneStep done = scene.step(workspaces);
        EXPECT_EQ(done.complete, scene.self_overlaps().size() == 3);
        return done;
    };
    EXPECT_EQ(step(2, 10000).needed_pairs, 3U);
    EXPECT_EQ(step(3, 7).needed_triangle_pairs, 3 * pairs_of_one);
    EXPECT_TRUE(step(3, static_cast<std::uint32_t>(3 * pairs_of_one)).complete);
}

// Without a call, after all kinds of changes, as after set_pose().
TEST(SceneDeform, AChangeIsFoundWithoutACall) {
    const std::vector<LayerPair> told = {{.effects = Ask::collide | Ask::overlap}};
    const std::vector<LayerPair> found = {{.effects = Ask::collide | Ask::overlap | Ask::tear}};
    const Plan told_plan = effects_plan(told), found_plan = effects_plan(found);
    Live sheet(test::grid_sheet(10, 10), {.triangles = 400, .vertices = 200});
    const test::OpenModel ball = test::open_tiny(test::icosphere(2));
    Scene a(told_plan), b(found_plan);
    std::vector<Workspace> workspaces(1);
    const SceneObject soft = {&sheet.model(), 0, Pose()};
    const SceneObject hard = {&ball.model, 0, shifted(5, 5, 1.5)};
    const ObjectId id = *a.add(soft);
    for (Scene* scene : {&a, &b}) static_cast<void>(scene->add(hard));
    static_cast<void>(b.remove(b.object_at(0)));
    static_cast<void>(b.add(soft));
    static_cast<void>(b.add(hard));
    const auto step = [&] {
        EXPECT_TRUE(a.set_pose(id, Pose()));
        EXPECT_TRUE(a.step(workspaces).complete);
        EXPECT_TRUE(b.step(workspaces).complete);
        EXPECT_EQ(a.state_hash() != 0, b.state_hash() != 0);
        EXPECT_EQ(a.overlaps().size(), b.overlaps().size());
        for (std::size_t i = 0; i < std::min(a.overlaps().size(), b.overlaps().size()); ++i) {
            EXPECT_TRUE(std::ranges::equal(a.overlaps()[i].triangles, b.overlaps()[i].triangles));
        }
        return b.overlaps().size();
    };
    EXPECT_EQ(step(), 0U);
    for (Double3& p : sheet.positions) p.z = 1;
    sheet.refit();
    EXPECT_EQ(step(), 1U);
    std::vector<std::uint32_t> numbers(200);
    for (std::uint32_t i = 0; i < 200; ++i) numbers[i] = i;
    EXPECT_TRUE((*sheet).remove(numbers));
    EXPECT_EQ(step(), 0U);
    const std::vector<format::Triangle> again = {{{60, 61, 72}}, {{60, 72, 71}}};
    EXPECT_TRUE((*sheet).append(again));
    EXPECT_EQ(step(), 1U);
    // Nothing changed: nothing is asked.
    ASSERT_TRUE(b.step(workspaces).complete);
    EXPECT_EQ(b.counts().moved, 0U);
    EXPECT_EQ(b.counts().kept, b.counts().candidates);
}

// By hand: a ball inside another collides with it. Once the outer one has torn, it may be open, so
// nothing is known, although it has all its triangles again.
TEST(SceneDeform, ATearIsFoundThoughNoTriangleIsMissing) {
    const std::vector<LayerPair> pairs = {
        {.effects = Ask::collide | Ask::tear, .body = Body::solid}};
    const Plan plan = effects_plan(pairs);
    const test::TestMesh ball = test::icosphere(2);
    Live outer(test::moved_by(ball, 4, {}), {.triangles = 400});
    const test::OpenModel inner = test::open_tiny(ball);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    static_cast<void>(scene.add({&outer.model(), 0, Pose()}));
    static_cast<void>(scene.add({&inner.model, 0, Pose()}));
    ASSERT_TRUE(scene.step(workspaces).complete);
    ASSERT_EQ(scene.hits().size(), 1U);
    EXPECT_EQ(scene.hits()[0].collision.hit, Answer::yes);
    const std::vector<format::Triangle> again = {ball.triangles[0]};
    const std::vector<std::uint32_t> number = {(*outer).append(again).value()};
    EXPECT_TRUE((*outer).remove(number));
    ASSERT_TRUE(scene.step(workspaces).complete);
    ASSERT_EQ(scene.hits().size(), 1U);
    EXPECT_EQ(scene.hits()[0].collision.hit, Answer::unknown);
}

TEST(SceneHaptic, BoundsHoldAndTheLastAnswerStays) {
    const std::vector<LayerPair> bounded = {
        {.effects = Ask::haptic, .max_distance = 3, .work = 40}};
    const std::vector<LayerPair> free = {
        {.effects = Ask::haptic, .max_distance = 3, .work = 100'000'000}};
    const Plan bounded_plan = effects_plan(bounded), free_plan = effects_plan(free);
    const test::OpenModel organ = test::open_tiny(test::torus(2, 0.7, 80, 40));
    const test::OpenModel probe =
        test::open_tiny(test::moved_by(test::icosphere(3), 0.2, {0, 0, 0}));
    Scene tight(bounded_plan), wide(free_plan);
    std::vector<Workspace> workspaces(1);
    Workspace workspace;
    std::vector<ObjectId> ids;
    for (Scene* scene : {&tight, &wide}) {
        static_cast<void>(scene->add({&organ.model, 0, Pose()}));
        ids.push_back(*scene->add({&probe.model, 0, shifted(2, 0, 0.95)}));
    }
    std::size_t late = 0;
    for (int i = 0; i < 60; ++i) {
        const Pose pose = shifted(2 * std::cos(0.02 * i), 2 * std::sin(0.02 * i), 0.95);
        ASSERT_TRUE(tight.set_pose(ids[0], pose) && wide.set_pose(ids[1], pose));
        ASSERT_TRUE(tight.step(workspaces).complete && wide.step(workspaces).complete);
        const Pair pair{organ.model, probe.model, Placement::world(Pose(), pose)};
        const auto expected = distance(pair, workspace, {.max_distance = 3});
        ASSERT_TRUE(expected);
        ASSERT_EQ(wide.bounded_distances().size(), 1U);
        const SceneBoundedDistance& whole = wide.bounded_distances()[0];
        EXPECT_TRUE(whole.distance.is_complete && whole.last.is_known && whole.last.late == 0);
        EXPECT_EQ(whole.distance.nearest->upper, expected->upper);
        ASSERT_EQ(tight.bounded_distances().size(), 1U);
        const SceneBoundedDistance& part = tight.bounded_distances()[0];
        EXPECT_LE(part.distance.lower, expected->upper);
        EXPECT_GE(part.distance.upper, expected->lower);
        late += part.distance.is_complete ? 0 : 1;
        EXPECT_EQ(part.last.late > 0, !part.distance.is_complete);
    }
    EXPECT_GT(late, 5U);
}

// The caller's broad phase gives the same, also with objects that are asked about themselves.
TEST(SceneEffects, GivenCandidatesGiveTheSame) {
    const std::vector<LayerPair> pairs = {
        {.effects = Ask::continuous | Ask::self | Ask::collide},
        {.a = 0, .b = 1, .effects = Ask::haptic, .max_distance = 1, .work = 300},
        {.a = 1, .b = 1, .effects = Ask::self}};
    const Plan plan = effects_plan(pairs);
    const test::OpenModel ball = test::open_tiny(
        test::joined(test::icosphere(1), test::moved_by(test::icosphere(1), 1, {0.5, 0, 0})));
    Scene own(plan), given(plan);
    std::vector<Workspace> workspaces(2);
    std::mt19937 random(9);
    std::vector<ObjectId> ids;
    for (std::uint32_t i = 0; i < 12; ++i) {
        const Pose pose = test::random_pose(random, 4);
        ids.push_back(*own.add({&ball.model, i % 2, pose}));
        static_cast<void>(given.add({&ball.model, i % 2, pose}));
    }
    for (int step = 0; step < 6; ++step) {
        for (const ObjectId id : ids) {
            const Pose pose = test::random_pose(random, 4);
            ASSERT_TRUE(own.set_pose(id, pose) && given.set_pose(id, pose));
        }
        ASSERT_TRUE(own.step(workspaces).complete);
        std::vector<BoxPair> all;
        for (std::uint32_t a = 0; a < 12; ++a) {
            for (std::uint32_t b = a + 1; b < 12; ++b) all.push_back({a, b});
        }
        static_cast<void>(given.boxes());
        ASSERT_TRUE(given.step_with(all, workspaces).complete);
        ASSERT_EQ(own.state_hash(), given.state_hash());
        ASSERT_EQ(own.self_overlaps().size(), 12U);
        for (const SceneHit& hit : own.hits()) {
            const bool are_of_one = own.model_of(hit.a) == nullptr || hit.a == hit.b;
            EXPECT_TRUE(are_of_one || hit.pair != 2U) << "objects of a layer that asks for self";
        }
    }
}

// The box of a model without triangles is absent, though its numbers lie within those of others.
TEST(SceneEffects, GivenPairsWithAbsentBoxesAreIgnored) {
    const std::vector<LayerPair> pairs = {{.effects = Ask::collide}};
    const Plan plan = effects_plan(pairs, {.objects = 3, .pairs = 1});
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    const test::OpenModel empty = test::open_tiny(test::TestMesh{});
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    for (const test::OpenModel* model : {&ball, &ball, &empty}) {
        static_cast<void>(scene.add({&model->model, 0, Pose()}));
    }
    const std::vector<BoxPair> all = {{0, 1}, {0, 2}, {1, 2}};
    EXPECT_GT(scene.boxes()[2].lower[0], scene.boxes()[2].upper[0]);
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_EQ(scene.counts().candidates, 1U);
    const SceneStep given = scene.step_with(all, workspaces);
    EXPECT_TRUE(given.complete);
    EXPECT_EQ(given.needed_pairs, 0U);
    EXPECT_EQ(scene.counts().candidates, 1U);
}

// By hand: one pane is 0.95 above the plate. Another is 1 above it, up to rounding, as the limit.
TEST(SceneEffects, APermittedErrorKeepsWhatIsWithinTheLimit) {
    const test::OpenModel plate = test::open_slanted(test::slanted_plate());
    std::vector<Workspace> workspaces(1);
    for (const double error : {0.0, 0.1}) {
        const std::vector<LayerPair> pairs = {{.a = 0,
                                               .b = 1,
                                               .effects = Ask::distance | Ask::within,
                                               .tolerance = 0.97,
                                               .max_distance = 1,
                                               .max_error = error}};
        const Plan plan = effects_plan(pairs);
        for (int k = 0; k < 40; ++k) {
            const test::OpenModel panes =
                test::open_slanted(test::slanted_panes(1 + k * 2.5e-13, 0.95));
            Scene scene(plan);
            static_cast<void>(scene.add({&plate.model, 0, Pose()}));
            static_cast<void>(scene.add({&panes.model, 1, Pose()}));
            ASSERT_TRUE(scene.step(workspaces).complete);
            ASSERT_EQ(scene.hits().size(), 1U) << k;
            EXPECT_EQ(scene.hits()[0].holds, Ask::distance | Ask::within) << k;
        }
    }
}

// In modes that take small numbers for 0, a way of such a length is one, and such a gap too.
TEST(SceneEffects, FloatModesChangeNeitherWaysNorGivenPairs) {
    const std::vector<LayerPair> pairs = {{.effects = Ask::continuous | Ask::distance}};
    const Plan plan = effects_plan(pairs);
    const test::OpenModel speck = test::open_tiny(test::moved_by(test::unit_cube(), 0x1p-140, {}),
                                                  {.double_precision = true});
    const std::vector<BoxPair> all = {{0, 1}};
    for (const test::FloatMode& mode : test::float_modes()) {
        Scene scene(plan);
        std::vector<Workspace> workspaces(1);
        const ObjectId first = *scene.add({&speck.model, 0, Pose()});
        static_cast<void>(scene.add({&speck.model, 0, shifted(0x1p-138, 0, 0)}));
        const Pose moved = shifted(0, 0x1p-1060, 0);
        std::vector<std::uint64_t> counts;
        static_cast<void>(test::run_in(mode, [&] {
            for (int step = 0; step < 4; ++step) {
                if (step == 1) static_cast<void>(scene.set_pose(first, moved));
                static_cast<void>(scene.step_with(all, workspaces));
                counts.push_back(scene.counts().moved);
                counts.push_back(scene.counts().candidates);
            }
        }));
        EXPECT_EQ(counts, (std::vector<std::uint64_t>{2, 0, 1, 0, 1, 0, 0, 0})) << mode.name;
    }
}

// The triangles of a distance of 0 are left out, those of a small distance are not.
TEST(SceneEffects, FloatModesChangeNoHash) {
    const std::vector<LayerPair> pairs = {{.effects = Ask::distance, .max_distance = 0x1p-1000}};
    const Plan plan = effects_plan(pairs);
    const test::OpenModel speck = test::open_tiny(test::moved_by(test::unit_cube(), 0x1p-1060, {}),
                                                  {.double_precision = true});
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    static_cast<void>(scene.add({&speck.model, 0, Pose()}));
    static_cast<void>(scene.add({&speck.model, 0, shifted(0x1p-1058, 0, 0)}));
    ASSERT_TRUE(scene.step(workspaces).complete);
    ASSERT_EQ(scene.distances().size(), 1U);
    ASSERT_GT(scene.distances()[0].distance.lower, 0);
    const std::uint64_t expected = scene.state_hash();
    for (const test::FloatMode& mode : test::float_modes()) {
        std::uint64_t hash = 0;
        static_cast<void>(test::run_in(mode, [&] { hash = scene.state_hash(); }));
        EXPECT_EQ(hash, expected) << mode.name;
    }
}

std::uint64_t ticks = 0;
std::uint64_t tick() noexcept {
    return ++ticks;
}

TEST(SceneEffects, AClockOfTheCallersTellsWhatEffectsTake) {
    const std::vector<LayerPair> pairs = {{.effects = Ask::collide | Ask::overlap | Ask::self}};
    const Plan plan = effects_plan(pairs);
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    for (int i = 0; i < 3; ++i)
        static_cast<void>(scene.add({&ball.model, 0, shifted(0.1 * i, 0, 0)}));
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_EQ(scene.counts().query_ticks + scene.counts().box_ticks, 0U);
    for (std::uint32_t slot = 0; slot < 3; ++slot) {
        ASSERT_TRUE(scene.set_pose(scene.object_at(slot), shifted(0.2 * slot, 0, 0)));
    }
    scene.set_clock(tick);
    ASSERT_TRUE(scene.step(workspaces).complete);
    const SceneCounts& counts = scene.counts();
    const auto ticks_of = [&](Ask effect) {
        const auto at = std::find(kSceneEffects.begin(), kSceneEffects.end(), effect);
        return counts.ticks[static_cast<std::size_t>(at - kSceneEffects.begin())];
    };
    EXPECT_EQ(ticks_of(Ask::overlap), 3U) << "one for each pair";
    EXPECT_EQ(ticks_of(Ask::collide), 3U);
    EXPECT_EQ(ticks_of(Ask::self), 0U) << "kept";
    EXPECT_EQ(ticks_of(Ask::distance), 0U);
    EXPECT_EQ(counts.box_ticks, 1U);
    EXPECT_EQ(counts.query_ticks, 13U);
    EXPECT_EQ(counts.list_ticks, 1U);
}

}  // namespace
}  // namespace cdprep
