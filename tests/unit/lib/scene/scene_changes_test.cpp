// SPDX-License-Identifier: MIT
// Random scenes of rigid and of live models that move, change, and have limits of work. The oracles
// are single queries and brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "cdprep/advanced/object_box.h"
#include "cdprep/live_model.h"
#include "cdprep/scene.h"
#include "cdprep/self.h"
#include "support/aligned_bytes.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/rounds.h"
#include "support/run_threads.h"
#include "support/same_distance.h"

namespace cdprep {
namespace {

// Models of layers 0 and 1 may change. Layer 1 also has motions, of rigid models.
const std::vector<LayerPair> kChangingPairs = {
    {.a = 0,
     .b = 0,
     .effects = Ask::self | Ask::collide | Ask::overlap | Ask::deform,
     .lists_stays = true},
    {.a = 1, .b = 0, .effects = Ask::within | Ask::overlap | Ask::tear, .tolerance = 0.2},
    {.a = 1, .b = 1, .effects = Ask::continuous | Ask::collide, .impact = {.tolerance = 0.05}},
    {.a = 1, .b = 2, .effects = Ask::haptic, .max_distance = 0.5, .work = 1'000'000'000},
    {.a = 2, .b = 2, .effects = Ask::self},
    {.a = 2,
     .b = 3,
     .effects = Ask::haptic | Ask::within,
     .tolerance = 0.1,
     .max_distance = 1,
     .work = 30},
    {.a = 3, .b = 3, .effects = Ask::continuous, .body = Body::solid}};

Plan changing_plan(std::uint32_t threads, std::uint32_t triangle_pairs = 60000) {
    Plan::Compiled compiled = Plan::compile(
        {.pairs = kChangingPairs,
         .limits = {
             .objects = 24, .pairs = 400, .threads = threads, .triangle_pairs = triangle_pairs}});
    for (const std::string& refusal : compiled.refusals) ADD_FAILURE() << refusal;
    return std::move(*compiled.plan);
}

/// A sheet that folds and tears, and the mesh that it is at present.
class SoftSheet {
public:
    explicit SoftSheet(std::uint32_t seed) : random_(seed), mesh_(test::grid_sheet(5, 5)) {
        flat_ = mesh_.positions;
        const auto arrays = build::build_model(mesh_.positions, mesh_.triangles,
                                               {.bounds = build::BvhBounds::aligned});
        const LiveLimits limits = {.triangles = 120, .vertices = 40};
        memory_ = test::AlignedBytes(LiveModel::bytes(arrays.value(), limits).value());
        live_.emplace(LiveModel::in(memory_.span(), arrays.value(), limits).value());
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) numbers_.push_back(i);
    }
    [[nodiscard]] const Model& model() const {
        return live_->model();
    }
    void change() {
        switch (random_() % 4) {
            case 0:
                return tear();
            case 1:
                return mend();
            default:
                return fold();
        }
    }
    /// The triangles as answers name them.
    void rename(std::vector<TrianglePair>& pairs, bool is_a, bool is_b) const {
        for (TrianglePair& pair : pairs) {
            if (is_a) pair.a = numbers_[pair.a];
            if (is_b) pair.b = numbers_[pair.b];
        }
        std::ranges::sort(pairs);
    }
    [[nodiscard]] const test::TestMesh& mesh() const {
        return mesh_;
    }

private:
    /// Folds the sheet about a line, or moves its vertices on a grid of 1/4. Vertices often meet.
    void fold() {
        const double bend = static_cast<double>(random_() % 5) / 4;
        for (std::size_t i = 0; i < flat_.size(); ++i) {
            Double3 p = flat_[i];
            if (bend < 0.5 && p.x > 2) p = {4 - p.x, p.y, 0.25 + (p.x - 2) * bend};
            p.z += static_cast<double>(random_() % 4) / 4 * bend;
            mesh_.positions[i] = {p.x / 4, p.y / 4, p.z / 4};
        }
        EXPECT_TRUE(live_->refit(mesh_.positions));
        if (random_() % 2 == 0) live_->rebuild(1000);
    }
    void tear() {
        if (numbers_.size() < 20) return;
        const std::size_t at = random_() % numbers_.size();
        const std::vector<std::uint32_t> removed = {numbers_[at]};
        EXPECT_TRUE(live_->remove(removed));
        numbers_.erase(numbers_.begin() + static_cast<std::ptrdiff_t>(at));
        mesh_.triangles.erase(mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(at));
    }
    void mend() {
        if (numbers_.size() > 100) return;
        const auto corner = [&] { return static_cast<std::uint32_t>(random_() % flat_.size()); };
        const std::vector<format::Triangle> added = {{{corner(), corner(), corner()}}};
        const auto number = live_->append(added);
        ASSERT_TRUE(number);
        numbers_.push_back(number.value());
        mesh_.triangles.push_back(added[0]);
    }

    std::mt19937 random_;
    test::TestMesh mesh_;
    std::vector<Double3> flat_;
    std::vector<std::uint32_t> numbers_;  ///< by triangle of the mesh
    test::AlignedBytes memory_{0};
    std::optional<LiveModel> live_;
};

/// All pairs of triangles of one mesh that touch and share no vertex.
std::vector<TrianglePair> own_pairs_of(const test::TestMesh& mesh) {
    const auto surface = test::surface_of(mesh);
    std::vector<TrianglePair> pairs;
    for (std::uint32_t i = 0; i < surface.size(); ++i) {
        for (std::uint32_t j = i + 1; j < surface.size(); ++j) {
            const auto &a = mesh.triangles[i].vertex, &b = mesh.triangles[j].vertex;
            if (std::ranges::find_first_of(a, b) != std::end(a)) continue;
            if (triangles_touch_by_segments(surface[i], surface[j])) pairs.push_back({i, j});
        }
    }
    return pairs;
}

/// An effect that holds for two objects, or for one.
using Holding = std::tuple<ObjectId, ObjectId, Ask>;

class ChangingWorld {
public:
    ChangingWorld(std::uint32_t seed, const Plan& plan)
        : random_(seed), plan_(plan), scene_(plan), workspaces_(plan.limits().threads) {
        rigid_.push_back(test::open_tiny(test::icosphere(1)));
        rigid_.push_back(test::open_tiny(test::torus(0.7, 0.2, 10, 6)));
        rigid_.push_back(test::open_tiny(test::klein_bottle(8, 7)));
        for (std::uint32_t i = 0; i < 2; ++i)
            soft_.push_back(std::make_unique<SoftSheet>(seed + i));
    }
    std::uint32_t any(std::uint32_t below) {
        return static_cast<std::uint32_t>(random_() % below);
    }
    void add() {
        Entry entry;
        entry.soft = any(4) == 0 ? soft_[any(2)].get() : nullptr;
        entry.model = entry.soft ? &entry.soft->model() : &rigid_[any(3)].model;
        entry.layer = entry.soft ? 0 : any(4);
        entry.start = entry.pose = test::random_pose(random_, 2);
        const auto id = scene_.add({entry.model, entry.layer, entry.pose});
        ASSERT_EQ(id.has_value(), entries_.size() < plan_.limits().objects);
        if (id) entries_[*id] = entry;
    }
    void change_one() {
        if (entries_.empty()) return;
        const auto at =
            std::next(entries_.begin(), any(static_cast<std::uint32_t>(entries_.size())));
        Entry& entry = at->second;
        switch (any(8)) {
            case 0:
                EXPECT_TRUE(scene_.remove(at->first));
                entries_.erase(at);
                return;
            case 1:
                entry.layer = entry.soft ? 0 : any(4);
                EXPECT_TRUE(scene_.set_layer(at->first, entry.layer));
                return;
            case 2:
                entry.start = entry.pose = test::random_pose(random_, 2);
                EXPECT_TRUE(scene_.put(at->first, entry.pose));
                return;
            default:
                entry.pose = test::random_pose(random_, 2);
                EXPECT_TRUE(scene_.set_pose(at->first, entry.pose));
        }
    }
    void change_shapes() {
        for (auto& sheet : soft_) {
            if (any(2) == 0) sheet->change();
        }
    }
    void pause(Ask effects) {
        scene_.set_paused(effects);
        paused_ = effects;
    }
    SceneStep step() {
        return scene_.step(workspaces_, test::run_threads);
    }
    /// The step is over: the ways begin at the present poses.
    void arrive() {
        for (auto& each : entries_) each.second.start = each.second.pose;
    }
    Scene& scene() {
        return scene_;
    }
    [[nodiscard]] std::size_t late() const {
        return late_;
    }

    /// Expects the answers of single queries. Returns what holds.
    std::vector<Holding> expect_answers() {
        held_.clear();
        streams_ = {scene_.hits(), scene_.overlaps(), scene_.self_overlaps(), scene_.impacts(),
                    scene_.bounded_distances()};
        for (auto a = entries_.begin(); a != entries_.end(); ++a) {
            expect_own(*a);
            for (auto b = std::next(a); b != entries_.end(); ++b) {
                const auto number = plan_.find_pair(a->second.layer, b->second.layer);
                if (number) expect_of_two(*a, *b, *number);
            }
        }
        EXPECT_TRUE(streams_.hits.empty());
        EXPECT_TRUE(streams_.overlaps.empty());
        EXPECT_TRUE(streams_.own.empty());
        EXPECT_TRUE(streams_.impacts.empty());
        EXPECT_TRUE(streams_.bounded.empty());
        return held_;
    }

private:
    struct Entry {
        const Model* model = nullptr;
        const SoftSheet* soft = nullptr;  ///< null: a rigid model
        std::uint32_t layer = 0;
        Pose start;
        Pose pose;
    };
    using Object = std::pair<const ObjectId, Entry>;
    struct Answers {
        std::span<const SceneHit> hits;
        std::span<const SceneOverlaps> overlaps;
        std::span<const SceneSelfOverlaps> own;
        std::span<const SceneImpact> impacts;
        std::span<const SceneBoundedDistance> bounded;
    };

    template <class Result>
    static const Result* take_next(std::span<const Result>& stream, const Object& a,
                                   const Object& b) {
        if (stream.empty() || stream[0].a != a.first || stream[0].b != b.first) return nullptr;
        const Result* const found = stream.data();
        stream = stream.subspan(1);
        return found;
    }
    void expect_hit(const Object& a, const Object& b, std::uint32_t number, Ask holds) {
        if (holds == Ask::nothing) return;
        const SceneHit* const hit = take_next(streams_.hits, a, b);
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->pair, number);
        EXPECT_EQ(hit->holds, holds);
        for (const Ask one : kSceneEffects) {
            if (contains(holds, one)) held_.emplace_back(a.first, b.first, one);
        }
    }

    void expect_own(const Object& object) {
        const auto number = plan_.find_pair(object.second.layer, object.second.layer);
        if (!number ||
            !contains(cdprep::without(plan_.pairs()[*number].effects, paused_), Ask::self)) {
            return;
        }
        const Model& model = *object.second.model;
        std::vector<TrianglePair> expected;
        if (object.second.soft) {
            expected = own_pairs_of(object.second.soft->mesh());
            object.second.soft->rename(expected, true, true);
        } else {
            expected.resize(self_overlaps(model, workspace_, {}));
            static_cast<void>(self_overlaps(model, workspace_, expected));
        }
        if (expected.empty()) return;
        ASSERT_FALSE(streams_.own.empty());
        ASSERT_EQ(streams_.own[0].object, object.first);
        EXPECT_EQ(streams_.own[0].pair, *number);
        EXPECT_TRUE(std::ranges::equal(streams_.own[0].triangles, expected));
        streams_.own = streams_.own.subspan(1);
        expect_hit(object, object, *number, Ask::self);
    }

    void expect_of_two(const Object& a, const Object& b, std::uint32_t number) {
        const LayerPair& asks = plan_.pairs()[number];
        const Ask effects = cdprep::without(asks.effects, paused_);
        const Pair pair{*a.second.model,
                        *b.second.model,
                        Placement::world(a.second.pose, b.second.pose),
                        {.body = asks.body, .overlap = asks.overlap}};
        Ask holds = Ask::nothing;
        const auto hold = [&](Ask effect, bool does) { holds = does ? holds | effect : holds; };
        if (contains(effects, Ask::collide)) {
            hold(Ask::collide, collide(pair, workspace_).hit == Answer::yes);
        }
        if (contains(effects, Ask::within)) {
            hold(Ask::within, within(pair, asks.tolerance, workspace_));
        }
        if (contains(effects, Ask::overlap)) hold(Ask::overlap, expect_overlaps(a, b, pair));
        if (contains(effects, Ask::continuous)) {
            hold(Ask::continuous, expect_impact(a, b, asks));
        }
        if (contains(effects, Ask::haptic)) hold(Ask::haptic, expect_bounded(a, b, pair, asks));
        expect_hit(a, b, number, holds);
    }

    bool expect_overlaps(const Object& a, const Object& b, const Pair& pair) {
        std::vector<TrianglePair> expected;
        if (a.second.soft && b.second.soft) {
            expected = test::brute_force_pairs(a.second.soft->mesh(), b.second.soft->mesh(),
                                               pair.placement);
            a.second.soft->rename(expected, true, false);
            b.second.soft->rename(expected, false, true);
        } else {
            expected.resize(overlaps(pair, workspace_, {}));
            static_cast<void>(overlaps(pair, workspace_, expected));
        }
        if (expected.empty()) return false;
        const SceneOverlaps* const found = take_next(streams_.overlaps, a, b);
        EXPECT_TRUE(found);
        EXPECT_TRUE(found && std::ranges::equal(found->triangles, expected));
        return true;
    }

    static Motion motion_of_entry(const Entry& entry) {
        const auto middle = root_box(*entry.model, Pose(), 0).middle;
        return Motion::between(entry.start, entry.pose, {middle[0], middle[1], middle[2]}).value();
    }
    bool expect_impact(const Object& a, const Object& b, const LayerPair& asks) {
        const Impact expected =
            time_of_impact({*a.second.model, *b.second.model, motion_of_entry(a.second),
                            motion_of_entry(b.second), asks.body},
                           workspace_, asks.impact);
        if (expected.kind == ImpactKind::none) return false;
        const SceneImpact* const found = take_next(streams_.impacts, a, b);
        EXPECT_TRUE(found);
        if (!found) return true;
        EXPECT_EQ(found->impact.kind, expected.kind);
        EXPECT_EQ(found->impact.lower, expected.lower);
        EXPECT_EQ(found->impact.upper, expected.upper);
        EXPECT_EQ(found->impact.steps, expected.steps);
        test::expect_same(found->impact.nearest, expected.nearest);
        return true;
    }

    /// A late answer depends on the poses before. Its bounds hold, and so does the last answer.
    bool expect_bounded(const Object& a, const Object& b, const Pair& pair, const LayerPair& asks) {
        const auto near = distance(pair, workspace_, {.max_distance = asks.max_distance});
        const SceneBoundedDistance* const found = take_next(streams_.bounded, a, b);
        if (!found) {
            EXPECT_FALSE(near) << "a near pair is never left out";
            return false;
        }
        EXPECT_LE(found->distance.lower, asks.max_distance);
        if (found->distance.is_complete) {
            EXPECT_TRUE(near) << "all is proven to be farther";
            test::expect_same(found->distance.nearest, near);
            EXPECT_EQ(found->last.late, 0U);
        } else {
            ++late_;
            const auto exact = distance(pair, workspace_);
            EXPECT_TRUE(exact && found->distance.lower <= exact->upper &&
                        found->distance.upper >= exact->lower);
            EXPECT_GT(found->last.late, 0U);
        }
        if (found->last.is_known) {
            const Pair then{pair.a, pair.b, found->last.placement};
            test::expect_same(found->last.distance.nearest,
                              distance(then, workspace_, {.max_distance = asks.max_distance}));
        }
        return true;
    }

    std::mt19937 random_;
    const Plan& plan_;
    std::vector<test::OpenModel> rigid_;
    std::vector<std::unique_ptr<SoftSheet>> soft_;
    std::map<ObjectId, Entry> entries_;
    Scene scene_;
    std::vector<Workspace> workspaces_;
    Workspace workspace_;
    Ask paused_ = Ask::nothing;
    Answers streams_;
    std::vector<Holding> held_;
    std::size_t late_ = 0;
};

std::set<Holding> events_of(const Scene& scene, EventKind kind) {
    std::set<Holding> keys;
    for (const SceneEvent& event : scene.events()) {
        if (event.kind == kind) keys.insert({event.a, event.b, event.effect});
    }
    return keys;
}

std::set<Holding> minus(const std::set<Holding>& keys, const std::set<Holding>& others) {
    std::set<Holding> rest;
    std::ranges::set_difference(keys, others, std::inserter(rest, rest.begin()));
    return rest;
}

struct Seen {
    std::map<Ask, std::size_t> begun;
    std::size_t late = 0, kept = 0, complete = 0, incomplete = 0;
};

/// Runs a scene with random changes. Counts what is seen.
void run_world(std::uint32_t seed, const Plan& plan, Seen& seen) {
    ChangingWorld world(seed, plan);
    for (int i = 0; i < 16; ++i) world.add();
    std::set<Holding> held;
    for (int step = 0; step < 12; ++step) {
        const std::uint64_t before = world.scene().state_hash();
        if (world.step().complete) {
            const std::vector<Holding> list = world.expect_answers();
            const std::set<Holding> holding(list.begin(), list.end());
            const auto begins = events_of(world.scene(), EventKind::begins);
            const auto ends = events_of(world.scene(), EventKind::ends);
            // A change of the layer may also end an effect and begin it again.
            EXPECT_EQ(minus(begins, ends), minus(holding, held));
            EXPECT_EQ(minus(ends, begins), minus(held, holding));
            for (const Holding& key : begins) ++seen.begun[std::get<Ask>(key)];
            seen.kept += world.scene().counts().kept;
            ++seen.complete;
            held = holding;
            world.arrive();
        } else {
            // Nothing has changed. The ways still begin in the last step that was complete.
            EXPECT_EQ(world.scene().state_hash(), before);
            ++seen.incomplete;
        }
        ASSERT_FALSE(testing::Test::HasFailure()) << "scene " << seed << ", step " << step;
        for (std::uint32_t i = world.any(6); i > 0; --i) world.change_one();
        world.change_shapes();
        if (world.any(3) == 0) world.add();
        if (world.any(4) == 0) {
            world.pause(world.any(2) == 0 ? Ask::nothing : kSceneEffects[world.any(8)]);
        }
    }
    seen.late += world.late();
}

TEST(SceneChanges, EqualSingleQueriesAndBruteForce) {
    const Plan plan = changing_plan(2);
    Seen seen;
    const std::uint32_t scenes = test::asks_all() ? 300 : 8;
    for (std::uint32_t seed = 0; seed < scenes && !HasFailure(); ++seed) {
        run_world(seed, plan, seen);
    }
    EXPECT_EQ(seen.incomplete, 0U);
    for (const Ask one : kSceneEffects) {
        if (!contains(plan.effects(), one)) continue;
        EXPECT_GT(seen.begun[one], 15U) << find_needs(one)->name;
    }
    EXPECT_GT(seen.late, 20U);
    EXPECT_GT(seen.kept, 100U);
}

// A step that lacks room changes nothing: not the ways, the shapes or the known distances.
TEST(SceneChanges, StepsThatLackRoomChangeNothing) {
    const Plan plan = changing_plan(2, 400);
    Seen seen;
    const std::uint32_t scenes = test::asks_all() ? 300 : 8;
    for (std::uint32_t seed = 50; seed < 50 + scenes && !HasFailure(); ++seed) {
        run_world(seed, plan, seen);
    }
    EXPECT_GT(seen.incomplete, 10U);
    EXPECT_GT(seen.complete, 10U);
}

TEST(SceneChanges, ThreadsGiveTheSame) {
    const Plan one = changing_plan(1), many = changing_plan(8);
    ChangingWorld a(3, one), b(3, many);
    for (ChangingWorld* world : {&a, &b}) {
        for (int i = 0; i < 24; ++i) world->add();
    }
    for (int step = 0; step < 10; ++step) {
        ASSERT_TRUE(a.step().complete && b.step().complete);
        ASSERT_EQ(a.scene().state_hash(), b.scene().state_hash());
        ASSERT_GT(a.scene().impacts().size() + a.scene().self_overlaps().size(), 2U);
        for (ChangingWorld* world : {&a, &b}) {
            for (int i = 0; i < 8; ++i) world->change_one();
            world->change_shapes();
        }
    }
}

// After a step in which objects moved, the next one finds them standing; from then on all is kept.
TEST(SceneChanges, AStepWithoutChangesSoonAsksNothing) {
    const Plan plan = changing_plan(1);
    ChangingWorld world(4, plan);
    for (int i = 0; i < 24; ++i) world.add();
    ASSERT_TRUE(world.step().complete);
    world.arrive();
    for (int i = 0; i < 10; ++i) world.change_one();
    world.change_shapes();
    ASSERT_TRUE(world.step().complete);
    world.arrive();
    ASSERT_TRUE(world.step().complete);
    static_cast<void>(world.expect_answers());
    ASSERT_TRUE(world.step().complete);
    const std::uint64_t hash = world.scene().state_hash();
    EXPECT_EQ(world.scene().counts().moved, 0U);
    EXPECT_EQ(world.scene().counts().kept, world.scene().counts().candidates);
    for (const Ask one : kSceneEffects) EXPECT_EQ(world.scene().counts().calls_of(one), 0U);
    for (const SceneEvent& event : world.scene().events()) {
        EXPECT_EQ(event.kind, EventKind::stays);
        EXPECT_EQ(event.reason, EventReason::unchanged);
    }
    static_cast<void>(world.expect_answers());
    ASSERT_TRUE(world.step().complete);
    EXPECT_EQ(world.scene().state_hash(), hash);
}

}  // namespace
}  // namespace cdprep
