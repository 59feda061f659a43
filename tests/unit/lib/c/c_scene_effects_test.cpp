// SPDX-License-Identifier: MIT
// Self, continuous and haptic in scenes of the C API, beside those of C++.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "cdprep/cdprep.h"
#include "cdprep/scene.h"
#include "support/c_models.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

constexpr std::uint32_t kObjects = 10;

/// One scene in C and in C++, of the same objects.
class TwoScenes {
public:
    TwoScenes() : model_(file_), own_(open_tiny(mesh())), scene_(plan_), workspaces_(1) {
        cdprep_layer_pair pair;
        cdprep_layer_pair_init(&pair, sizeof pair);
        pair.effects = CDPREP_ASK_SELF | CDPREP_ASK_CONTINUOUS | CDPREP_ASK_HAPTIC;
        pair.max_distance = 0.5;
        pair.impact_tolerance = 0.01;
        pair.impact_steps = 100;
        pair.work = 60;
        cdprep_plan_options options;
        cdprep_plan_options_init(&options, sizeof options);
        options.layer_pairs = &pair;
        options.layer_pair_count = 1;
        options.max_objects = kObjects;
        options.max_pairs = 100;
        options.max_triangle_pairs = 5000;
        cdprep_error error;
        EXPECT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &c_plan_, &error), CDPREP_OK)
            << error.message;
        EXPECT_EQ(cdprep_scene_make(c_plan_, nullptr, 0, &c_scene_, &error), CDPREP_OK);
        for (std::uint32_t i = 0; i < kObjects; ++i) add(random_pose(random_, 3));
    }
    TwoScenes(const TwoScenes&) = delete;
    TwoScenes& operator=(const TwoScenes&) = delete;
    ~TwoScenes() {
        cdprep_scene_end(c_scene_);
        cdprep_plan_end(c_plan_);
    }
    void step() {
        cdprep_step step;
        ASSERT_EQ(cdprep_scene_step(c_scene_, workspace_.get(), &step, nullptr), CDPREP_OK);
        ASSERT_EQ(step.complete, std::uint32_t{CDPREP_YES});
        ASSERT_TRUE(scene_.step(workspaces_).complete);
        std::uint64_t hash = 0;
        ASSERT_EQ(cdprep_scene_hash(c_scene_, &hash, nullptr), CDPREP_OK);
        EXPECT_EQ(hash, scene_.state_hash());
    }
    void move() {
        for (std::uint32_t i = 0; i < kObjects; ++i) {
            const Pose pose = random_pose(random_, 3);
            const cdprep_pose rows = rows_in_c(pose);
            if (i % 3 == 0) {
                EXPECT_EQ(cdprep_scene_put(c_scene_, &ids_[i], &rows, 1, nullptr), CDPREP_OK);
                EXPECT_TRUE(scene_.put(scene_.object_at(i), pose));
            } else {
                EXPECT_EQ(cdprep_scene_set_poses(c_scene_, &ids_[i], &rows, 1, nullptr), CDPREP_OK);
                EXPECT_TRUE(scene_.set_pose(scene_.object_at(i), pose));
            }
        }
    }
    void expect_equal() {
        const cdprep_scene_self_overlap* own = nullptr;
        std::size_t count = 0;
        ASSERT_EQ(cdprep_scene_self_overlaps(c_scene_, &own, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(count, kObjects);
        for (std::size_t i = 0; i < count; ++i) {
            const SceneSelfOverlaps& expected = scene_.self_overlaps()[i];
            EXPECT_EQ(own[i].id.slot, expected.object.slot);
            ASSERT_EQ(own[i].count, expected.triangles.size());
            EXPECT_EQ(own[i].items[0].b, expected.triangles[0].b);
        }
        const cdprep_scene_impact* hits = nullptr;
        ASSERT_EQ(cdprep_scene_impacts(c_scene_, &hits, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(count, scene_.impacts().size());
        impacts += count;
        for (std::size_t i = 0; i < count; ++i) {
            const SceneImpact& expected = scene_.impacts()[i];
            EXPECT_EQ(hits[i].b.slot, expected.b.slot);
            EXPECT_EQ(hits[i].impact.lower, expected.impact.lower);
            EXPECT_EQ(hits[i].impact.upper, expected.impact.upper);
            EXPECT_EQ(hits[i].impact.steps, expected.impact.steps);
        }
        const cdprep_scene_bounded* near = nullptr;
        ASSERT_EQ(cdprep_scene_bounded_distances(c_scene_, &near, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(count, scene_.bounded_distances().size());
        bounded += count;
        for (std::size_t i = 0; i < count; ++i) {
            const SceneBoundedDistance& expected = scene_.bounded_distances()[i];
            EXPECT_EQ(near[i].bounded.lower, expected.distance.lower);
            EXPECT_EQ(near[i].bounded.complete == CDPREP_YES, expected.distance.is_complete);
            EXPECT_EQ(near[i].has_last == CDPREP_YES, expected.last.is_known);
            EXPECT_EQ(near[i].late, expected.last.late);
            EXPECT_EQ(near[i].last.lower, expected.last.distance.lower);
            EXPECT_EQ(near[i].last_pose_b.rows[9],
                      expected.last.placement.pose_b().translation().x);
        }
        cdprep_counts counts;
        ASSERT_EQ(cdprep_scene_counts(c_scene_, &counts, nullptr), CDPREP_OK);
        EXPECT_EQ(counts.n[CDPREP_SCENE_SELF], scene_.counts().calls_of(Ask::self));
        EXPECT_EQ(counts.n[CDPREP_SCENE_HAPTIC], scene_.counts().calls_of(Ask::haptic));
        EXPECT_EQ(counts.n[CDPREP_SCENE_CONTINUOUS], scene_.counts().calls_of(Ask::continuous));
    }

    std::size_t impacts = 0, bounded = 0;

private:
    static TestMesh mesh() {
        return joined(icosphere(1), moved_by(icosphere(1), 1, {0.5, 0, 0}));
    }
    static Plan plan() {
        const std::vector<LayerPair> pairs = {{.effects = Ask::self | Ask::continuous | Ask::haptic,
                                               .max_distance = 0.5,
                                               .impact = {.tolerance = 0.01, .most_steps = 100},
                                               .work = 60}};
        return *Plan::compile(
                    {.pairs = pairs,
                     .limits = {.objects = kObjects, .pairs = 100, .triangle_pairs = 5000}})
                    .plan;
    }
    void add(const Pose& pose) {
        cdprep_object_options options;
        cdprep_object_options_init(&options, sizeof options);
        options.model = model_.get();
        options.world_from_model = rows_in_c(pose);
        ids_.emplace_back();
        EXPECT_EQ(cdprep_scene_add(c_scene_, &options, 1, &ids_.back(), nullptr), CDPREP_OK);
        EXPECT_TRUE(scene_.add({&own_.model, 0, pose}));
    }

    std::mt19937 random_{11};
    AlignedBytes file_ = bake_tiny(mesh().positions, mesh().triangles);
    CModel model_;
    CWorkspace workspace_;
    cdprep_plan* c_plan_ = nullptr;
    cdprep_scene* c_scene_ = nullptr;
    std::vector<cdprep_object> ids_;
    OpenModel own_;
    Plan plan_ = plan();
    Scene scene_;
    std::vector<Workspace> workspaces_;
};

TEST(CSceneEffects, EqualThoseOfCpp) {
    TwoScenes scenes;
    for (int step = 0; step < 6; ++step) {
        scenes.step();
        scenes.expect_equal();
        if (testing::Test::HasFailure()) return;
        scenes.move();
    }
    EXPECT_GT(scenes.impacts, 20U);
    EXPECT_GT(scenes.bounded, 5U);
}

/// A sheet in the plane z = 0 that can tear.
class CSheet {
public:
    CSheet() {
        cdprep_live_options options;
        cdprep_live_options_init(&options, sizeof options);
        options.model = base_.get();
        options.max_triangles = static_cast<std::uint32_t>(mesh_.triangles.size());
        options.max_vertices = static_cast<std::uint32_t>(mesh_.positions.size());
        EXPECT_EQ(cdprep_live_make(&options, nullptr, 0, &live_, nullptr), CDPREP_OK);
    }
    CSheet(const CSheet&) = delete;
    CSheet& operator=(const CSheet&) = delete;
    ~CSheet() {
        cdprep_live_end(live_);
    }
    [[nodiscard]] const cdprep_model* model() const {
        return cdprep_live_model(live_);
    }
    /// Brings the vertices with x > 2 to the other side of that line, and all to a height.
    void fold(bool is_folded, double z, cdprep_workspace* workspace) {
        std::vector<Double3> positions = mesh_.positions;
        for (Double3& p : positions) p = {is_folded && p.x > 2 ? 4 - p.x : p.x, p.y, z};
        cdprep_live_move moved;
        cdprep_live_move_init(&moved, sizeof moved);
        moved.positions = &positions[0].x;
        moved.count = positions.size();
        ASSERT_EQ(cdprep_live_refit(live_, &moved, workspace, nullptr), CDPREP_OK);
    }
    void remove_all() {
        std::vector<std::uint32_t> numbers(mesh_.triangles.size());
        for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
        ASSERT_EQ(cdprep_live_remove(live_, numbers.data(), numbers.size(), nullptr), CDPREP_OK);
    }

private:
    TestMesh mesh_ = grid_sheet(4, 4);
    AlignedBytes file_ = bake_tiny(mesh_.positions, mesh_.triangles, {.double_precision = true});
    CModel base_{file_};
    cdprep_live* live_ = nullptr;
};

// By hand: a ball of radius 1 about (2, 2, 3), and a sheet that changes without a call.
TEST(CSceneEffects, AChangeOfALiveModelIsFoundWithoutACall) {
    CSheet sheet;
    const AlignedBytes file = bake_tiny(icosphere(2).positions, icosphere(2).triangles);
    const CModel ball(file);
    const CWorkspace workspace;
    cdprep_layer_pair pair;
    cdprep_layer_pair_init(&pair, sizeof pair);
    pair.effects = CDPREP_ASK_COLLIDE | CDPREP_ASK_SELF | CDPREP_ASK_TEAR;
    cdprep_plan_options options;
    cdprep_plan_options_init(&options, sizeof options);
    options.layer_pairs = &pair;
    options.layer_pair_count = 1;
    options.max_objects = 2;
    options.max_pairs = 3;
    options.max_triangle_pairs = 5000;
    cdprep_plan* plan = nullptr;
    ASSERT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &plan, nullptr), CDPREP_OK);
    cdprep_scene* scene = nullptr;
    ASSERT_EQ(cdprep_scene_make(plan, nullptr, 0, &scene, nullptr), CDPREP_OK);
    cdprep_plan_end(plan);
    std::array<cdprep_object_options, 2> objects;
    for (cdprep_object_options& one : objects) cdprep_object_options_init(&one, sizeof one);
    objects[0].model = sheet.model();
    objects[1].model = ball.get();
    objects[1].world_from_model = rows_in_c(Pose::from_quaternion(1, 0, 0, 0, {2, 2, 3}).value());
    std::array<cdprep_object, 2> ids;
    ASSERT_EQ(cdprep_scene_add(scene, objects.data(), 2, ids.data(), nullptr), CDPREP_OK);
    const auto holds = [&] {
        cdprep_step step;
        EXPECT_EQ(cdprep_scene_step(scene, workspace.get(), &step, nullptr), CDPREP_OK);
        EXPECT_EQ(step.complete, std::uint32_t{CDPREP_YES});
        const cdprep_scene_hit* hits = nullptr;
        std::size_t count = 0;
        EXPECT_EQ(cdprep_scene_hits(scene, &hits, &count, nullptr), CDPREP_OK);
        std::uint32_t all = 0;
        for (std::size_t i = 0; i < count; ++i) all |= hits[i].holds;
        return all;
    };
    EXPECT_EQ(holds(), 0U);
    sheet.fold(false, 2.5, workspace.get());
    EXPECT_EQ(holds(), std::uint32_t{CDPREP_ASK_COLLIDE});
    sheet.fold(true, 2.5, workspace.get());
    EXPECT_EQ(holds(), std::uint32_t{CDPREP_ASK_COLLIDE | CDPREP_ASK_SELF});
    sheet.fold(true, 0, workspace.get());
    EXPECT_EQ(holds(), std::uint32_t{CDPREP_ASK_SELF});
    sheet.remove_all();
    EXPECT_EQ(holds(), 0U);
    cdprep_scene_end(scene);
}

TEST(CSceneEffects, RefusesOptionsThatNothingReads) {
    cdprep_layer_pair pair;
    const auto why_of = [&](auto change) {
        cdprep_layer_pair_init(&pair, sizeof pair);
        pair.effects = CDPREP_ASK_COLLIDE;
        change();
        cdprep_plan_options options;
        cdprep_plan_options_init(&options, sizeof options);
        options.layer_pairs = &pair;
        options.layer_pair_count = 1;
        cdprep_plan* plan = nullptr;
        cdprep_error error;
        EXPECT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &plan, &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(plan, nullptr);
        return error.why;
    };
    EXPECT_EQ(why_of([&] { pair.impact_tolerance = 1; }), CDPREP_WHY_NO_MEANING);
    EXPECT_EQ(why_of([&] { pair.impact_steps = 7; }), CDPREP_WHY_NO_MEANING);
    EXPECT_EQ(why_of([&] { pair.work = 7; }), CDPREP_WHY_NO_MEANING);
    EXPECT_EQ(why_of([&] { pair.reserved = 1; }), CDPREP_WHY_NEWER_FIELD);
    EXPECT_EQ(why_of([&] { pair.effects = CDPREP_ASK_HAPTIC; }), CDPREP_WHY_OUT_OF_RANGE);
    EXPECT_EQ(why_of([&] {
                  pair.effects = CDPREP_ASK_SELF;
                  pair.b = 1;
              }),
              CDPREP_WHY_OUT_OF_RANGE);
    EXPECT_EQ(why_of([&] { pair.effects = CDPREP_ASK_CONTACTS | CDPREP_ASK_DEFORM; }),
              CDPREP_WHY_OUT_OF_RANGE);
}

}  // namespace
}  // namespace cdprep::test
