// SPDX-License-Identifier: MIT
#include "cdprep/scene.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "support/guarded_pages.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/rounds.h"

namespace cdprep {
namespace {

using test::AlignedBytes;

/// A file with all sections that a scene may read and others, each on pages of its own.
AlignedBytes whole_file(const test::TestMesh& mesh) {
    return test::on_pages(test::with_octree(test::with_hulls(test::with_contacts(
        test::with_one_piece(test::bake_tiny(mesh.positions, mesh.triangles))))));
}

/// Returns the hash after some steps of a plan, of one model in many places.
std::uint64_t hash_of_steps(const Plan& plan, const Model& model, int steps) {
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    std::mt19937 random(4);
    std::vector<ObjectId> objects;
    for (int i = 0; i < 8; ++i) objects.push_back(*scene.add({&model, 0, Pose()}));
    std::uint64_t hash = 0;
    for (int step = 0; step < steps; ++step) {
        for (const ObjectId object : objects) {
            static_cast<void>(scene.set_pose(object, test::random_pose(random, 3)));
        }
        EXPECT_TRUE(scene.step(workspaces).complete);
        hash = 31 * hash + scene.state_hash();
        // Nothing outside the plan is called.
        for (const Ask one : kSceneEffects) {
            if (contains(plan.effects(), one)) continue;
            EXPECT_EQ(scene.counts().calls_of(one), 0U);
        }
    }
    return hash;
}

/// Calls `visit` with a plan for each set of effects, of surfaces and of solids.
template <class Visit>
void for_each_plan(const Visit& visit) {
    for (std::uint32_t set = 1; set < 1U << kSceneEffects.size(); ++set) {
        LayerPair pair;
        for (std::size_t i = 0; i < kSceneEffects.size(); ++i) {
            if ((set >> i & 1) != 0) pair.effects = pair.effects | kSceneEffects[i];
        }
        if (contains(pair.effects, Ask::within)) pair.tolerance = 0.1;
        if ((pair.effects & (Ask::distance | Ask::haptic)) != Ask::nothing) pair.max_distance = 0.5;
        if (contains(pair.effects, Ask::haptic)) pair.work = 300;
        if (contains(pair.effects, Ask::continuous)) pair.impact.tolerance = 0.05;
        for (const Body body : {Body::surface, Body::solid}) {
            pair.body = body;
            const std::vector<LayerPair> pairs = {pair};
            const auto compiled = Plan::compile(
                {.pairs = pairs,
                 .limits = {.objects = 8, .pairs = 40, .triangle_pairs = 30000, .contacts = 600}});
            if (compiled.plan) visit(*compiled.plan);
        }
    }
}

// A scene reads no section that its plan does not name: all others are closed to every access.
TEST(ScenePages, EachPlanReadsOnlyWhatItNeeds) {
    const AlignedBytes file = whole_file(test::icosphere(1));
    const test::OpenModel whole = test::open_tiny(AlignedBytes(file.span()));
    int plans = 0;
    for_each_plan([&](const Plan& plan) {
        const format::SectionSet wanted = sections_for(plan.asks_of(0));
        const test::GuardedPages pages(file.span(), wanted);
        EXPECT_GE(pages.guarded(), 3);
        const auto model = Model::open(pages.bytes(), wanted);
        ASSERT_TRUE(model);
        // Plans with the costly effects are many, and a time of impact takes many distances.
        const bool is_short =
            (plan.effects() & (Ask::continuous | Ask::self | Ask::haptic)) != Ask::nothing;
        const int steps = is_short && !test::asks_all() ? 3 : 100;
        ASSERT_EQ(hash_of_steps(plan, *model, steps), hash_of_steps(plan, whole.model, steps))
            << plan.describe();
        ++plans;
    });
    // Of surfaces, all sets but those of haptic and distance. Of solids, those without haptic that
    // read the body: overlap, within and self do not.
    EXPECT_EQ(plans, (255 - 64) + (127 - 7));
}

// The test above would notice: a section that is needed and closed ends the program.
TEST(ScenePagesDeathTest, AClosedSectionIsNoticed) {
    const AlignedBytes file = whole_file(test::icosphere(1));
    const std::vector<LayerPair> pairs = {{.effects = Ask::overlap}};
    const Plan plan =
        *Plan::compile(
             {.pairs = pairs, .limits = {.objects = 8, .pairs = 40, .triangle_pairs = 30000}})
             .plan;
    const format::SectionSet wanted = sections_for(plan.asks_of(0));
    test::GuardedPages pages(file.span(), wanted);
    const auto model = Model::open(pages.bytes(), wanted);
    ASSERT_TRUE(model);
    pages.close(format::SectionId::bvh_leaves);
    EXPECT_DEATH(hash_of_steps(plan, *model, 1), "");
}

}  // namespace
}  // namespace cdprep
