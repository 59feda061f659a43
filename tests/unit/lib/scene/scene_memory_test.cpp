// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "cdprep/scene.h"
#include "support/counted_memory.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/scene_plans.h"

namespace cdprep {
namespace {

// Objects are added, removed, moved and asked, with one set of events after the other.
TEST(SceneMemory, NothingIsAllocatedAfterConstruction) {
    const test::TestMesh mesh = test::icosphere(2);
    const test::OpenModel ball = test::open_tiny(
        test::with_contacts(test::with_one_piece(test::bake_tiny(mesh.positions, mesh.triangles))));
    const std::vector<LayerPair> pairs = {
        {.effects = Ask::collide | Ask::overlap | Ask::within | Ask::distance | Ask::contacts,
         .tolerance = 0.1,
         .max_distance = 0.5,
         .body = Body::solid}};
    const Plan plan =
        *Plan::compile(
             {.pairs = pairs,
              .limits = {.objects = 30, .pairs = 500, .triangle_pairs = 100000, .contacts = 8000}})
             .plan;
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    std::mt19937 random(3);
    std::vector<ObjectId> objects(30);
    std::size_t events = 0;
    const std::size_t before = test::most = test::used;
    for (int step = 0; step < 50; ++step) {
        for (ObjectId& object : objects) {
            const Pose pose = test::random_pose(random, 3);
            if (random() % 4 == 0) static_cast<void>(scene.remove(object));
            if (scene.set_pose(object, pose)) continue;
            if (const auto added = scene.add({&ball.model, 0, pose})) object = *added;
        }
        if (!scene.step(workspaces).complete) FAIL();
        events += scene.events().size();
    }
    EXPECT_EQ(test::most, before);
    EXPECT_GT(events, 100U);
}

// No set of effects allocates, of surfaces or of solids.
TEST(SceneMemory, NothingIsAllocatedByAnyPlan) {
    const test::TestMesh mesh = test::icosphere(1);
    const test::OpenModel ball = test::open_tiny(
        test::with_contacts(test::with_one_piece(test::bake_tiny(mesh.positions, mesh.triangles))));
    std::vector<Workspace> workspaces(1);
    int plans = 0;
    test::for_each_plan([&](const Plan& plan) {
        Scene scene(plan);
        std::mt19937 random(5);
        std::vector<ObjectId> objects;
        for (int i = 0; i < 5; ++i) objects.push_back(*scene.add({&ball.model, 0, Pose()}));
        const std::size_t before = test::most = test::used;
        for (int step = 0; step < 2; ++step) {
            for (const ObjectId object : objects) {
                static_cast<void>(scene.set_pose(object, test::random_pose(random, 3)));
            }
            if (!scene.step(workspaces).complete) FAIL();
        }
        ASSERT_EQ(test::most, before) << plan.describe();
        ++plans;
    });
    EXPECT_GT(plans, 300);
}

TEST(SceneMemory, NothingIsAllocatedForMotions) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(2));
    const std::vector<LayerPair> pairs = {
        {.effects = Ask::continuous | Ask::self | Ask::haptic, .max_distance = 0.5, .work = 200}};
    const Plan plan =
        *Plan::compile(
             {.pairs = pairs, .limits = {.objects = 12, .pairs = 200, .triangle_pairs = 1000}})
             .plan;
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    std::mt19937 random(3);
    std::vector<ObjectId> objects;
    for (int i = 0; i < 12; ++i) {
        objects.push_back(*scene.add({&ball.model, 0, test::random_pose(random, 3)}));
    }
    std::size_t impacts = 0;
    const std::size_t before = test::most = test::used;
    for (int step = 0; step < 10; ++step) {
        for (const ObjectId object : objects) {
            static_cast<void>(scene.set_pose(object, test::random_pose(random, 3)));
        }
        if (!scene.step(workspaces).complete) FAIL();
        impacts += scene.impacts().size();
    }
    EXPECT_EQ(test::most, before);
    EXPECT_GT(impacts, 10U);
}

}  // namespace
}  // namespace cdprep
