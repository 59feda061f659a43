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
#include "support/scene_plans.h"

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

/// One of kParts parts of the plans. In all poses, all of them together would take minutes.
class ScenePages : public testing::TestWithParam<int> {
public:
    static constexpr int kParts = 6;
};

// A scene reads no section that its plan does not name: all others are closed to every access.
TEST_P(ScenePages, EachPlanReadsOnlyWhatItNeeds) {
    const AlignedBytes file = whole_file(test::icosphere(1));
    const test::OpenModel whole = test::open_tiny(AlignedBytes(file.span()));
    int plans = 0;
    test::for_each_plan([&](const Plan& plan) {
        if (plans++ % kParts != GetParam()) return;
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
    });
    // Of surfaces, all sets but those of haptic and distance. Of solids, those without haptic that
    // read the body: overlap, within and self do not.
    EXPECT_EQ(plans, (255 - 64) + (127 - 7));
}

INSTANTIATE_TEST_SUITE_P(Parts, ScenePages, testing::Range(0, ScenePages::kParts));

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
