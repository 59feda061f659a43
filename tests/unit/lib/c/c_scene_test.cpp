// SPDX-License-Identifier: MIT
// Plans, scenes and the broad phase through the C API, beside those of C++.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "c_api.h"
#include "cdprep/scene.h"
#include "support/c_lanes.h"
#include "support/c_models.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

AlignedBytes baked(const TestMesh& mesh) {
    return bake_tiny(mesh.positions, mesh.triangles);
}

AlignedBytes with_contacts_of(const AlignedBytes& file, bool is_convex) {
    return with_contacts(is_convex ? with_one_piece(file) : with_pieces(file));
}

// By hand: cubes of side 1, and boxes.
TEST(CScene, AProgramInC99GetsTheResults) {
    const AlignedBytes file = baked(unit_cube());
    const CModel cube(file);
    const CWorkspace workspace;
    AlignedBytes memory(100'000);
    void* const start = memory.span().data();
    const char* wrong = ask_scene(cube.get(), workspace.get(), start, memory.size());
    EXPECT_EQ(wrong, nullptr) << wrong;
    wrong = ask_broad_phase(workspace.get(), start, memory.size());
    EXPECT_EQ(wrong, nullptr) << wrong;
}

// Layers 0 and 1 collide and list triangles. 1 and 2 collide as solids and list contacts. 2 and 2
// have a tolerance and a distance. Work ends the contacts of 0 and 0. The first pair is dropped, so
// numbers in C are one higher than in C++.
const std::vector<LayerPair> kPairs = {
    {.a = 5, .b = 6},
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
    {.a = 0,
     .b = 0,
     .effects = Ask::contacts,
     .contacts = {.most = 3, .work = 40, .cluster_angle = 0.2}},
    {.a = 3, .b = 0, .effects = Ask::contacts}};

constexpr std::uint32_t kMostTrianglePairs = 500;  // sometimes too few
constexpr std::uint32_t kMostContacts = 60;        // likewise
constexpr std::array kOrigin = {0.3, -1.7, 40.0};

cdprep_contact_options in_c(const ContactOptions& contacts) {
    cdprep_contact_options to;
    cdprep_contact_options_init(&to, sizeof to);
    to.tolerance = contacts.tolerance;
    to.manifold = contacts.manifold == Manifold::four ? 4 : 0;
    to.most = contacts.most;
    to.work = contacts.work;
    to.cluster_angle = contacts.cluster_angle;
    return to;
}

cdprep_layer_pair in_c(const LayerPair& pair) {
    cdprep_layer_pair to;
    cdprep_layer_pair_init(&to, sizeof to);
    to.a = pair.a;
    to.b = pair.b;
    to.effects = static_cast<std::uint32_t>(pair.effects);
    to.body = pair.body == Body::solid ? CDPREP_SOLID : CDPREP_SURFACE;
    to.overlap = pair.overlap == Overlap::proper ? CDPREP_PROPER : CDPREP_CLOSED;
    to.tolerance = pair.tolerance;
    to.max_distance = pair.max_distance;
    to.lists_stays = pair.lists_stays ? CDPREP_YES : CDPREP_NO;
    return to;
}

/// Pairs of layers in C, and the options of contacts to which they point.
struct CPairs {
    std::vector<cdprep_contact_options> contacts;
    std::vector<cdprep_layer_pair> pairs;

    explicit CPairs(const std::vector<LayerPair>& given) {
        for (const LayerPair& pair : given) contacts.push_back(in_c(pair.contacts));
        for (std::size_t i = 0; i < given.size(); ++i) {
            pairs.push_back(in_c(given[i]));
            // The last pair has the defaults.
            const bool has_own = contains(given[i].effects, Ask::contacts) && i + 1 < given.size();
            if (has_own) pairs.back().contacts = &contacts[i];
        }
    }
};

ObjectId in_cpp(const cdprep_object& id) {
    return {id.slot, id.generation};
}

/// The same objects in a scene of C and in one of C++.
class Twins {
public:
    Twins(std::uint32_t seed, std::uint32_t lanes, std::uint32_t plan_lanes,
          std::uint32_t max_pairs)
        : random_(seed),
          files_{with_contacts_of(baked(icosphere(2)), true),
                 with_contacts_of(baked(torus(0.7, 0.2, 12, 8)), false),
                 with_contacts_of(baked(moved_by(unit_cube(), 0.5, {0, 0, 0})), true)},
          lanes_(lanes),
          plan_(*Plan::compile({.pairs = kPairs,
                                .limits = {.objects = 24,
                                           .pairs = max_pairs,
                                           .triangle_pairs = kMostTrianglePairs,
                                           .contacts = kMostContacts},
                                .origin = {kOrigin[0], kOrigin[1], kOrigin[2]}})
                     .plan),
          scene_(plan_) {
        for (const AlignedBytes& file : files_) {
            c_models_.push_back(std::make_unique<CModel>(file));
            models_.push_back(Model::open(file.span()).value());
        }
        const CPairs given(kPairs);
        cdprep_plan_options options;
        cdprep_plan_options_init(&options, sizeof options);
        options.layer_pairs = given.pairs.data();
        options.layer_pair_count = static_cast<std::uint32_t>(given.pairs.size());
        options.max_objects = 24;
        options.max_pairs = max_pairs;
        options.max_triangle_pairs = kMostTrianglePairs;
        options.max_contacts = kMostContacts;
        options.lanes = plan_lanes;
        std::copy(kOrigin.begin(), kOrigin.end(), options.origin);
        cdprep_plan* plan = nullptr;
        EXPECT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &plan, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_scene_make(plan, nullptr, 0, &c_scene_, nullptr), CDPREP_OK);
        cdprep_plan_end(plan);  // the scene keeps it
    }
    Twins(const Twins&) = delete;
    Twins& operator=(const Twins&) = delete;
    ~Twins() {
        cdprep_scene_end(c_scene_);
    }

    void add() {
        const std::uint32_t model = any(3), layer = any(4);
        const Pose pose = random_pose(random_, kReach_);
        cdprep_object_options options;
        cdprep_object_options_init(&options, sizeof options);
        options.model = c_models_[model]->get();
        options.layer = layer;
        options.world_from_model = rows_in_c(pose);
        cdprep_object id{};
        const int code = cdprep_scene_add(c_scene_, &options, 1, &id, nullptr);
        const auto added = scene_.add({&models_[model], layer, pose});
        ASSERT_EQ(code == CDPREP_OK, added.has_value());
        if (!added) return;
        EXPECT_EQ(in_cpp(id), *added);
        ids_.push_back(id);
    }
    void change_one() {
        if (ids_.empty()) return;
        const std::size_t at = any(static_cast<std::uint32_t>(ids_.size()));
        const cdprep_object id = ids_[at];
        const std::uint32_t kind = any(8);
        if (kind == 0) {
            EXPECT_EQ(cdprep_scene_remove(c_scene_, &id, 1, nullptr), CDPREP_OK);
            EXPECT_TRUE(scene_.remove(in_cpp(id)));
            ids_.erase(ids_.begin() + static_cast<std::ptrdiff_t>(at));
        } else if (kind == 1) {
            const std::uint32_t layer = any(4);
            EXPECT_EQ(cdprep_scene_set_layer(c_scene_, id, layer, nullptr), CDPREP_OK);
            EXPECT_TRUE(scene_.set_layer(in_cpp(id), layer));
        } else {
            const Pose pose = random_pose(random_, kReach_);
            const cdprep_pose to = rows_in_c(pose);
            EXPECT_EQ(cdprep_scene_set_poses(c_scene_, &id, &to, 1, nullptr), CDPREP_OK);
            EXPECT_TRUE(scene_.set_pose(in_cpp(id), pose));
        }
    }
    /// Pauses or resumes some effects.
    void pause() {
        const std::uint32_t effects = any(32) & static_cast<std::uint32_t>(plan_.effects());
        EXPECT_EQ(cdprep_scene_set_paused(c_scene_, effects, nullptr), CDPREP_OK);
        scene_.set_paused(static_cast<Ask>(effects));
    }
    /// Steps both, and expects equal results. In C, some steps get their candidates here.
    void step() {
        cdprep_step step;
        if (any(3) == 0) {
            const std::vector<cdprep_box_pair> pairs = candidates();
            ASSERT_EQ(cdprep_scene_step_with(c_scene_, pairs.data(), pairs.size(), lanes_.get(),
                                             &step, nullptr),
                      CDPREP_OK);
            ++of_caller;
        } else {
            ASSERT_EQ(cdprep_scene_step(c_scene_, lanes_.get(), &step, nullptr), CDPREP_OK);
        }
        const SceneStep expected = scene_.step(workspaces_);
        EXPECT_EQ(step.complete == CDPREP_YES, expected.complete);
        EXPECT_EQ(step.needed_pairs, expected.needed_pairs);
        EXPECT_EQ(step.needed_triangle_pairs, expected.needed_triangle_pairs);
        EXPECT_EQ(step.needed_contacts, expected.needed_contacts);
        without_room += expected.needed_triangle_pairs > 0 ? 1 : 0;
        without_contact_room += expected.needed_contacts > 0 ? 1 : 0;
        incomplete += expected.complete ? 0 : 1;
        expect_equal_hits();
        expect_equal_overlaps();
        expect_equal_distances();
        expect_equal_contacts();
        expect_equal_events();
        expect_equal_numbers();
        expect_equal_objects();
    }
    std::uint32_t any(std::uint32_t below) {
        return static_cast<std::uint32_t>(random_() % below);
    }
    [[nodiscard]] std::size_t most_tasks() const {
        return lanes_.threads.most;
    }

    /// Of all steps.
    std::size_t hits = 0, overlaps = 0, distances = 0, contacts = 0, points = 0, events = 0;
    std::size_t stays = 0, incomplete = 0, without_room = 0, without_contact_room = 0;
    std::size_t of_caller = 0, unsearched = 0, objects = 0;

private:
    /// Pairs of slots whose boxes meet, by brute force, and some that do not.
    std::vector<cdprep_box_pair> candidates() {
        const cdprep_world_box* boxes = nullptr;
        std::size_t count = 0;
        EXPECT_EQ(cdprep_scene_boxes(c_scene_, &boxes, &count, nullptr), CDPREP_OK);
        EXPECT_EQ(count, 24u);
        const auto expected = scene_.boxes();
        EXPECT_EQ(std::memcmp(boxes, expected.data(), expected.size_bytes()), 0);
        std::set<std::uint32_t> slots;
        for (const cdprep_object& id : ids_) slots.insert(id.slot);
        std::vector<cdprep_box_pair> pairs;
        for (const std::uint32_t a : slots) {
            for (const std::uint32_t b : slots) {
                bool meets = true;
                for (int axis = 0; axis < 3; ++axis) {
                    meets = meets && boxes[a].lower[axis] <= boxes[b].upper[axis] &&
                            boxes[b].lower[axis] <= boxes[a].upper[axis];
                }
                if (a < b && (meets || any(8) == 0)) pairs.push_back({a, b});
            }
        }
        return pairs;
    }
    void expect_equal_hits() {
        const cdprep_scene_hit* found = nullptr;
        std::size_t count = 0;
        ASSERT_EQ(cdprep_scene_hits(c_scene_, &found, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(count, scene_.hits().size());
        hits += count;
        for (std::size_t i = 0; i < count; ++i) {
            const SceneHit& hit = scene_.hits()[i];
            EXPECT_EQ(in_cpp(found[i].a), hit.a);
            EXPECT_EQ(in_cpp(found[i].b), hit.b);
            EXPECT_EQ(found[i].layer_pair, hit.pair + 1);
            EXPECT_EQ(found[i].holds, static_cast<std::uint32_t>(hit.holds));
            EXPECT_EQ(found[i].collision.hit, static_cast<std::uint32_t>(hit.collision.hit));
            EXPECT_EQ(found[i].collision.containment,
                      static_cast<std::uint32_t>(hit.collision.containment.answer));
            EXPECT_EQ(found[i].collision.winding, hit.collision.containment.winding);
        }
    }
    void expect_equal_overlaps() {
        const cdprep_scene_overlap* found = nullptr;
        std::size_t count = 0;
        ASSERT_EQ(cdprep_scene_overlaps(c_scene_, &found, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(count, scene_.overlaps().size());
        overlaps += count;
        for (std::size_t i = 0; i < count; ++i) {
            const SceneOverlaps& expected = scene_.overlaps()[i];
            EXPECT_EQ(in_cpp(found[i].a), expected.a);
            EXPECT_EQ(in_cpp(found[i].b), expected.b);
            EXPECT_EQ(found[i].layer_pair, expected.pair + 1);
            ASSERT_EQ(found[i].count, expected.triangles.size());
            for (std::size_t k = 0; k < found[i].count; ++k) {
                EXPECT_EQ(found[i].items[k].a, expected.triangles[k].a);
                EXPECT_EQ(found[i].items[k].b, expected.triangles[k].b);
            }
        }
    }
    void expect_equal_distances() {
        const cdprep_scene_distance* found = nullptr;
        std::size_t count = 0;
        ASSERT_EQ(cdprep_scene_distances(c_scene_, &found, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(count, scene_.distances().size());
        distances += count;
        for (std::size_t i = 0; i < count; ++i) {
            const SceneDistance& distance = scene_.distances()[i];
            EXPECT_EQ(in_cpp(found[i].a), distance.a);
            EXPECT_EQ(in_cpp(found[i].b), distance.b);
            EXPECT_EQ(found[i].layer_pair, distance.pair + 1);
            EXPECT_EQ(found[i].nearest.lower, distance.distance.lower);
            EXPECT_EQ(found[i].nearest.upper, distance.distance.upper);
            EXPECT_EQ(found[i].nearest.triangle_a, distance.distance.triangle_a);
            EXPECT_EQ(found[i].nearest.on_b[2], distance.distance.witness_b.z);
        }
    }
    void expect_equal_contacts() {
        const cdprep_scene_contact* found = nullptr;
        std::size_t count = 0;
        ASSERT_EQ(cdprep_scene_contacts(c_scene_, &found, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(count, scene_.contacts().size());
        contacts += count;
        for (std::size_t i = 0; i < count; ++i) {
            const SceneContacts& expected = scene_.contacts()[i];
            EXPECT_EQ(in_cpp(found[i].a), expected.a);
            EXPECT_EQ(in_cpp(found[i].b), expected.b);
            EXPECT_EQ(found[i].layer_pair, expected.pair + 1);
            EXPECT_EQ(found[i].complete == CDPREP_YES, expected.verdict.complete);
            EXPECT_EQ(found[i].searched == CDPREP_YES, expected.verdict.searched);
            EXPECT_EQ(found[i].found, expected.verdict.found);
            EXPECT_EQ(found[i].computed, expected.verdict.computed);
            EXPECT_EQ(found[i].work, expected.verdict.work);
            unsearched += expected.verdict.searched ? 0 : 1;
            ASSERT_EQ(found[i].count, expected.contacts.size());
            for (std::size_t k = 0; k < found[i].count; ++k) {
                expect_equal(found[i].items[k], expected.contacts[k]);
                points += found[i].items[k].point_count;
            }
        }
    }
    static void expect_equal(const double* point, const Double3& expected) {
        EXPECT_EQ(point[0], expected.x);
        EXPECT_EQ(point[1], expected.y);
        EXPECT_EQ(point[2], expected.z);
    }
    static void expect_equal(const cdprep_feature& feature, const ContactFeature& expected) {
        EXPECT_EQ(feature.kind, static_cast<std::uint32_t>(expected.kind));
        EXPECT_EQ(feature.edge, expected.edge);
        EXPECT_EQ(feature.triangle, expected.triangle);
        EXPECT_EQ(feature.vertex[0], expected.vertex);
    }
    static void expect_equal(const cdprep_contact& found, const Contact& expected) {
        EXPECT_EQ(found.piece_a, expected.piece_a);
        EXPECT_EQ(found.piece_b, expected.piece_b);
        EXPECT_EQ(found.id, expected.id);
        EXPECT_EQ(found.flags, expected.flags);
        EXPECT_EQ(found.members, expected.members);
        EXPECT_EQ(found.lower, expected.lower);
        EXPECT_EQ(found.upper, expected.upper);
        expect_equal(found.feature_a, expected.feature_a);
        expect_equal(found.feature_b, expected.feature_b);
        expect_equal(found.on_a, expected.point_a);
        expect_equal(found.on_b, expected.point_b);
        expect_equal(found.normal, expected.normal);
        ASSERT_EQ(found.point_count, expected.point_count);
        for (std::uint32_t i = 0; i < found.point_count; ++i) {
            EXPECT_EQ(found.points[i].id, expected.points[i].id);
            EXPECT_EQ(found.points[i].distance, expected.points[i].distance);
            expect_equal(found.points[i].on_a, expected.points[i].on_a);
            expect_equal(found.points[i].on_b, expected.points[i].on_b);
        }
    }
    void expect_equal_events() {
        const cdprep_event* found = nullptr;
        std::size_t count = 0;
        ASSERT_EQ(cdprep_scene_events(c_scene_, &found, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(count, scene_.events().size());
        events += count;
        for (std::size_t i = 0; i < count; ++i) {
            const SceneEvent& event = scene_.events()[i];
            EXPECT_EQ(in_cpp(found[i].a), event.a);
            EXPECT_EQ(in_cpp(found[i].b), event.b);
            EXPECT_EQ(found[i].layer_pair, event.pair + 1);
            EXPECT_EQ(found[i].effect, static_cast<std::uint32_t>(event.effect));
            EXPECT_EQ(found[i].kind == CDPREP_EVENT_BEGIN, event.kind == EventKind::begins);
            EXPECT_EQ(found[i].kind == CDPREP_EVENT_STAY, event.kind == EventKind::stays);
            stays += event.kind == EventKind::stays ? 1 : 0;
            EXPECT_EQ(found[i].reason, static_cast<std::uint32_t>(event.reason));
        }
    }
    void expect_equal_numbers() {
        std::uint64_t hash = 0;
        ASSERT_EQ(cdprep_scene_hash(c_scene_, &hash, nullptr), CDPREP_OK);
        EXPECT_EQ(hash, scene_.state_hash());
        cdprep_counts counts;
        ASSERT_EQ(cdprep_scene_counts(c_scene_, &counts, nullptr), CDPREP_OK);
        const SceneCounts& all = scene_.counts();
        const std::array<std::uint64_t, 13> expected = {scene_.object_count(),
                                                        all.moved,
                                                        all.candidates,
                                                        all.kept,
                                                        all.apart,
                                                        all.calls_of(Ask::collide),
                                                        all.calls_of(Ask::within),
                                                        all.calls_of(Ask::distance),
                                                        all.calls_of(Ask::overlap),
                                                        all.triangle_pairs,
                                                        all.calls_of(Ask::contacts),
                                                        all.contacts,
                                                        0};
        for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(counts.n[i], expected[i]) << i;
    }

    /// Slot by slot, free ones too.
    void expect_equal_objects() {
        for (std::uint32_t slot = 0; slot < 24; ++slot) {
            cdprep_object id = {7, 7};
            ASSERT_EQ(cdprep_scene_object_at(c_scene_, slot, &id, nullptr), CDPREP_OK);
            EXPECT_EQ(in_cpp(id), scene_.object_at(slot));
            cdprep_object_info info{};
            const int code = cdprep_scene_describe(c_scene_, id, &info, nullptr);
            const std::optional<SceneObject> expected = scene_.find(in_cpp(id));
            ASSERT_EQ(code == CDPREP_OK, expected.has_value());
            if (!expected) continue;
            ++objects;
            EXPECT_EQ(expected->model, scene_.model_of(in_cpp(id)));
            const auto number = static_cast<std::size_t>(expected->model - models_.data());
            EXPECT_EQ(info.model, c_models_[number]->get());
            EXPECT_EQ(info.layer, expected->layer);
            const cdprep_pose pose = rows_in_c(expected->world_from_model);
            EXPECT_EQ(std::memcmp(&info.world_from_model, &pose, sizeof pose), 0);
        }
    }

    static constexpr double kReach_ = 2;
    std::mt19937 random_;
    std::array<AlignedBytes, 3> files_;
    std::vector<std::unique_ptr<CModel>> c_models_;
    std::vector<Model> models_;
    CLanes lanes_;
    Plan plan_;
    Scene scene_;
    cdprep_scene* c_scene_ = nullptr;
    std::vector<Workspace> workspaces_{1};
    std::vector<cdprep_object> ids_;
};

/// Lanes of the workspace and of the plan, and the limit of pairs.
struct Setting {
    std::uint32_t lanes, plan_lanes, max_pairs;
};

// The law of this layer: the results of C are those of C++, step by step, on any lanes.
TEST(CScene, TheResultsAreThoseOfCpp) {
    std::size_t incomplete = 0, without_room = 0, without_contact_room = 0, steps = 0;
    std::size_t unsearched = 0;
    for (const Setting& setting :
         std::vector<Setting>{{1, 1, 200}, {3, 3, 200}, {2, 7, 200}, {5, 2, 200}, {2, 2, 40}}) {
        Twins twins(20261126 + setting.lanes, setting.lanes, setting.plan_lanes, setting.max_pairs);
        for (int step = 0; step < 150; ++step, ++steps) {
            if (twins.any(3) == 0 || step < 20) twins.add();
            for (std::uint32_t change = twins.any(5); change > 0; --change) twins.change_one();
            // The last steps are those of paused effects.
            if (step >= 110 && step % 4 == 0) twins.pause();
            twins.step();
            if (HasFatalFailure()) return;
        }
        incomplete += twins.incomplete;
        without_room += twins.without_room;
        without_contact_room += twins.without_contact_room;
        unsearched += twins.unsearched;
        EXPECT_GT(twins.contacts, 50u);
        EXPECT_GT(twins.points, 50u);
        EXPECT_GT(twins.of_caller, 20u);
        EXPECT_GT(twins.overlaps, 50u);
        EXPECT_GT(twins.stays, 50u);
        EXPECT_GT(twins.hits, 300u);
        EXPECT_GT(twins.distances, 100u);
        EXPECT_GT(twins.events, 200u);
        EXPECT_GT(twins.objects, 1000u);
        EXPECT_LE(twins.most_tasks(), setting.lanes);
        EXPECT_EQ(twins.most_tasks() > 1, setting.lanes > 1);
    }
    EXPECT_GT(incomplete, steps / 50);
    EXPECT_GT(without_room, 0u);
    EXPECT_GT(without_contact_room, 0u);
    EXPECT_GT(unsearched, 0u);
    EXPECT_LT(incomplete, steps / 5);
}

// Layer by layer, beyond the last too.
TEST(CScene, LayersAreThoseOfCpp) {
    const Plan expected =
        *Plan::compile({.pairs = kPairs, .limits = {.objects = 4, .pairs = 4}}).plan;
    const CPairs given(kPairs);
    cdprep_plan_options options;
    cdprep_plan_options_init(&options, sizeof options);
    options.layer_pairs = given.pairs.data();
    options.layer_pair_count = static_cast<std::uint32_t>(given.pairs.size());
    options.max_objects = options.max_pairs = 4;
    cdprep_plan* plan = nullptr;
    ASSERT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &plan, nullptr), CDPREP_OK);
    double reach = 0;
    for (std::uint32_t layer = 0; layer < CDPREP_LAYERS; ++layer) {
        cdprep_layer_info info{};
        ASSERT_EQ(cdprep_plan_layer(plan, layer, &info, nullptr), CDPREP_OK);
        EXPECT_EQ(info.ask, static_cast<std::uint32_t>(expected.asks_of(layer)));
        EXPECT_EQ(info.filter.layers, expected.filter_of(layer).layers);
        EXPECT_EQ(info.filter.accepts, expected.filter_of(layer).accepts);
        EXPECT_EQ(info.reach, expected.reach_of(layer));
        reach += info.reach;
    }
    EXPECT_GT(reach, 0.5);
    cdprep_plan_end(plan);
}

std::uint64_t c_ticks = 0;
std::uint64_t tick() {
    return ++c_ticks;
}

// A clock that counts its calls: each query is between two of them, so it takes one tick.
TEST(CScene, AClockOfTheCallerTimesEachEffect) {
    const AlignedBytes file = baked(unit_cube());
    const CModel cube(file);
    const CWorkspace workspace;
    const LayerPair pair = {.effects = Ask::collide | Ask::overlap | Ask::within,
                            .tolerance = 0.5,
                            .overlap = Overlap::proper};
    cdprep_layer_pair pair_in_c = in_c(pair);
    cdprep_plan_options options;
    cdprep_plan_options_init(&options, sizeof options);
    options.layer_pairs = &pair_in_c;
    options.layer_pair_count = 1;
    options.max_objects = options.max_pairs = 4;
    options.max_triangle_pairs = 500;
    cdprep_plan* plan = nullptr;
    cdprep_scene* scene = nullptr;
    ASSERT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &plan, nullptr), CDPREP_OK);
    ASSERT_EQ(cdprep_scene_make(plan, nullptr, 0, &scene, nullptr), CDPREP_OK);
    cdprep_plan_end(plan);
    std::array<cdprep_object_options, 2> objects;
    for (cdprep_object_options& object : objects) {
        cdprep_object_options_init(&object, sizeof object);
        object.model = cube.get();
    }
    objects[1].world_from_model.rows[9] = 0.5;
    std::array<cdprep_object, 2> ids{};
    ASSERT_EQ(cdprep_scene_add(scene, objects.data(), 2, ids.data(), nullptr), CDPREP_OK);
    const auto counts_after = [&](cdprep_clock now) {
        EXPECT_EQ(cdprep_scene_set_clock(scene, now, nullptr), CDPREP_OK);
        const std::array poses = {objects[0].world_from_model, objects[1].world_from_model};
        EXPECT_EQ(cdprep_scene_set_poses(scene, ids.data(), poses.data(), 2, nullptr), CDPREP_OK);
        cdprep_step step;
        EXPECT_EQ(cdprep_scene_step(scene, workspace.get(), &step, nullptr), CDPREP_OK);
        cdprep_counts counts;
        EXPECT_EQ(cdprep_scene_counts(scene, &counts, nullptr), CDPREP_OK);
        return counts;
    };
    const cdprep_counts without = counts_after(nullptr);
    for (std::size_t i = CDPREP_SCENE_TICKS_COLLIDE; i < 32; ++i) EXPECT_EQ(without.n[i], 0u) << i;
    const cdprep_counts with = counts_after(tick);
    EXPECT_EQ(with.n[CDPREP_SCENE_OVERLAP], 1u);
    EXPECT_EQ(with.n[CDPREP_SCENE_TICKS_OVERLAP], 1u);
    EXPECT_EQ(with.n[CDPREP_SCENE_TICKS_DISTANCE], 0u);
    EXPECT_EQ(with.n[CDPREP_SCENE_TICKS_CONTACTS], 0u);
    EXPECT_EQ(with.n[CDPREP_SCENE_TICKS_BOXES], 1u);
    EXPECT_GT(with.n[CDPREP_SCENE_TICKS_QUERIES], with.n[CDPREP_SCENE_TICKS_OVERLAP]);
    EXPECT_EQ(with.n[CDPREP_SCENE_TICKS_LISTS], 1u);
    std::uint64_t stages = 0;
    for (std::size_t i = CDPREP_SCENE_TICKS_BOXES; i < 32; ++i) stages += with.n[i];
    EXPECT_EQ(stages + 1, c_ticks) << "together they are the step";
    EXPECT_EQ(counts_after(nullptr).n[CDPREP_SCENE_TICKS_BOXES], 0u);
    cdprep_scene_end(scene);
}

}  // namespace
}  // namespace cdprep::test
