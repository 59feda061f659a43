// SPDX-License-Identifier: MIT
#include "query/object_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::cli {
namespace {

/// Objects of two models in three layers, at random. Layer 2 is not paired.
class Heap {
public:
    explicit Heap(std::uint32_t count) {
        std::mt19937 random(11);
        scene_.layers = {"a", "b", "c"};
        scene_.models = {"torus", "ball"};
        for (std::uint32_t i = 0; i < count; ++i) {
            scene_.motions.push_back(scenes::Motion::fixed(test::random_pose(random, 5)));
            scene_.objects.push_back(
                {.name = std::to_string(i), .model = i % 2, .layer = i % 3, .motion = i});
        }
        models_.resize(2);
        models_[0].model.emplace(std::move(torus_.model));
        models_[1].model.emplace(std::move(ball_.model));
    }
    [[nodiscard]] std::vector<PlacedObject> objects(const Plan& plan) const {
        auto objects = objects_of(scene_, plan, models_);
        if (!objects) ADD_FAILURE() << objects.error().message;
        return *objects;
    }

private:
    scenes::SceneFile scene_;
    std::vector<scenes::SceneModel> models_;
    test::OpenModel torus_ = test::open_tiny(test::torus(1, 0.2, 12, 6));
    test::OpenModel ball_ = test::open_tiny(test::icosphere(1));
};

Plan plan_of(const std::vector<LayerPair>& pairs) {
    auto compiled = Plan::compile({.pairs = pairs, .limits = {}});
    for (const std::string& refusal : compiled.refusals) ADD_FAILURE() << refusal;
    return *compiled.plan;
}

const std::vector<LayerPair> kNear = {{.a = 0, .b = 0, .effects = Ask::within, .tolerance = 0.5},
                                      {.a = 1, .b = 0, .effects = Ask::within, .tolerance = 0.25}};

// Brute force: every pair whose layers are paired and that is near is a candidate, and meets.
TEST(ObjectPairs, CandidatesHoldAllThatIsNear) {
    const Heap heap(120);
    const Plan plan = plan_of(kNear);
    const std::vector<PlacedObject> objects = heap.objects(plan);
    ASSERT_EQ(objects.size(), 80u) << "layer c is not asked";
    const auto pairs = ObjectPairs::find(objects, plan);
    ASSERT_TRUE(pairs) << pairs.error().message;
    EXPECT_EQ(pairs->possible(), 40u * 39 / 2 + 40 * 40);
    const auto candidates = pairs->candidates();
    EXPECT_TRUE(std::is_sorted(candidates.begin(), candidates.end()));
    EXPECT_LT(candidates.size(), pairs->possible() / 2);
    Workspace workspace;
    std::size_t near = 0;
    for (std::uint32_t a = 0; a < objects.size(); ++a) {
        for (std::uint32_t b = a + 1; b < objects.size(); ++b) {
            const bool is_candidate =
                std::binary_search(candidates.begin(), candidates.end(), BoxPair{a, b});
            if (!plan.find_pair(objects[a].layer, objects[b].layer)) {
                EXPECT_FALSE(is_candidate) << a << " " << b;
                continue;
            }
            if (!within(pairs->pair({a, b}), pairs->asked({a, b}).tolerance, workspace)) continue;
            ++near;
            EXPECT_TRUE(is_candidate && pairs->may_meet({a, b})) << a << " " << b;
        }
    }
    EXPECT_GT(near, 50u);
    EXPECT_EQ(pairs->asked({0, 1}).tolerance, 0.25);
}

// Of objects in one place all pairs meet: more than there is room for at first.
TEST(ObjectPairs, MakeRoomForAllCandidates) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(0));
    const Plan plan = plan_of({{.a = 0, .b = 0, .effects = Ask::overlap}});
    const std::vector<PlacedObject> objects(300, {0, 0, &ball.model, {}});
    const auto pairs = ObjectPairs::find(objects, plan);
    ASSERT_TRUE(pairs);
    EXPECT_EQ(pairs->candidates().size(), 300u * 299 / 2);
    EXPECT_EQ(pairs->possible(), 300u * 299 / 2);
}

TEST(ObjectPairs, NoObjectsHaveNoPairs) {
    const Plan plan = plan_of(kNear);
    const auto pairs = ObjectPairs::find({}, plan);
    ASSERT_TRUE(pairs);
    EXPECT_EQ(pairs->possible(), 0u);
    EXPECT_TRUE(pairs->candidates().empty());
    EXPECT_EQ(size_of({}), 0);
}

// The box of two unit cubes, one moved by (2, 3, 5), is 3 x 4 x 6.
TEST(ObjectPairs, SizeIsThatOfTheBoxAroundAllObjects) {
    const test::OpenModel cube = test::open_tiny(test::unit_cube());
    const Pose moved = *Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 3, 5});
    const std::vector<PlacedObject> objects = {{0, 0, &cube.model, {}}, {1, 0, &cube.model, moved}};
    EXPECT_NEAR(size_of(objects), std::sqrt(9.0 + 16 + 36), 1e-4);
    EXPECT_GE(size_of(objects), std::sqrt(9.0 + 16 + 36));
}

}  // namespace
}  // namespace cdprep::cli
