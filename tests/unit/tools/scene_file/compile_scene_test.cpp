// SPDX-License-Identifier: MIT
#include "scene_file/compile_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scene_file/effect_words.h"

namespace cdprep::scenes {
namespace {

constexpr SceneLimits kLimits = {.objects = 8, .pairs = 8};

/// Two models: the first in layers 0 and 1, the second in layer 2, which no pair names.
SceneFile scene_of(std::vector<AskedPair> pairs) {
    SceneFile scene;
    scene.name = "s.json";
    scene.layers = {"a", "b", "c"};
    scene.pairs = std::move(pairs);
    scene.models = {"m.obj", "n.obj"};
    scene.motions = {Motion::fixed({})};
    scene.objects = {{.name = "x", .model = 0, .layer = 0},
                     {.name = "y", .model = 0, .layer = 1},
                     {.name = "z", .model = 1, .layer = 2}};
    return scene;
}

TEST(CompileScene, FindsWhatEachModelMustServe) {
    const SceneFile scene =
        scene_of({{.asked = {.a = 0, .b = 1, .effects = Ask::collide, .body = Body::solid}},
                  {.asked = {.a = 1, .b = 1, .effects = Ask::within}}});
    const Plan::Compiled compiled = compile_scene(scene, kLimits);
    ASSERT_TRUE(compiled.plan);
    const std::vector<ModelNeeds> needs = needs_of_models(scene, asks_of_layers(*compiled.plan));
    ASSERT_EQ(needs.size(), 2u);
    EXPECT_EQ(needs[0].asks, Ask::collide | Ask::solid | Ask::within);
    EXPECT_EQ(needs[0].layers, 0b11u);
    EXPECT_EQ(needs[0].objects, 2u);
    EXPECT_EQ(needs[1].asks, Ask::nothing);
    EXPECT_TRUE(is_asked(scene, *compiled.plan, scene.objects[0]));
    EXPECT_FALSE(is_asked(scene, *compiled.plan, scene.objects[2]));
}

// A plan refuses the second pair and the body, so there is none; the first pair still asks.
TEST(AsksOfLayers, AreThoseOfThePairsThatAreValid) {
    SceneFile scene =
        scene_of({{.asked = {.a = 0, .b = 1, .effects = Ask::collide, .body = Body::solid}},
                  {.asked = {.a = 1, .b = 2, .effects = Ask::distance, .tolerance = 1}}});
    scene.bodies = {{}};
    scene.objects[2].body = 0;
    EXPECT_EQ(compile_scene(scene, kLimits).refusals.size(), 2u);
    LayerAsks asks = asks_of_layers(scene);
    EXPECT_EQ(asks[0], Ask::collide | Ask::solid);
    EXPECT_EQ(asks[1], Ask::collide | Ask::solid);
    EXPECT_EQ(asks[2], Ask::nothing);
    // With a plan, both ways agree.
    scene.pairs[1].asked.tolerance = 0;
    scene.objects[2].body = kNoBody;
    asks = asks_of_layers(scene);
    EXPECT_EQ(asks[2], Ask::distance);
    EXPECT_EQ(asks, asks_of_layers(*compile_scene(scene, kLimits).plan));
}

// The sentences name the file and the pair.
TEST(CompileScene, ListsAllRefusals) {
    const SceneFile scene =
        scene_of({{.asked = {.a = 0, .b = 1, .effects = Ask::response | Ask::inside}}});
    const Plan::Compiled compiled = compile_scene(scene, kLimits);
    EXPECT_FALSE(compiled.plan);
    ASSERT_EQ(compiled.refusals.size(), 2u);
    const std::string place = "s.json: Pair 0 of layers, 'a' and 'b': ";
    EXPECT_EQ(
        compiled.refusals[0],
        place +
            "inside is not supported in a scene. Choose from collide, overlap, distance, within, "
            "contacts, response, continuous, self, deform, tear, haptic.");
    EXPECT_EQ(compiled.refusals[1], place +
                                        "response needs bodies, but no object of these layers has "
                                        "the motion \"body\".");
}

// What its options mean depends on the effect, and that one is not built.
TEST(CompileScene, RefusesAnEffectThatIsNotBuiltOnce) {
    const SceneFile scene = scene_of(
        {{.asked = {.a = 0, .b = 1, .effects = Ask::inside, .tolerance = 3, .body = Body::solid}}});
    EXPECT_EQ(compile_scene(scene, kLimits).refusals.size(), 1u);
}

TEST(CompileScene, NamesTheLinesOfPairs) {
    SceneFile scene = scene_of({{.asked = {.a = 0, .b = 1, .effects = Ask::collide}, .line = 7},
                                {.asked = {.a = 1, .b = 0, .effects = Ask::collide}, .line = 9}});
    scene.changes = {{.deform = Twist{}}};
    scene.objects[0].change = 0;
    const std::vector<std::string> expected = {
        "s.json: line 9: /pairs/1: Pair 1 of layers, 'b' and 'a': layers 'b' and 'a' are also "
        "those of pair 0.",
        "s.json: Object 'x' in layer 'a' deforms. Add deform to the effects of pair 0 of layers, "
        "'a' and 'b' (line 7).",
        "s.json: Object 'x' in layer 'a' deforms. Add deform to the effects of pair 1 of layers, "
        "'b' and 'a' (line 9)."};
    EXPECT_EQ(compile_scene(scene, kLimits).refusals, expected);
}

// A live model answers its layer; its base is opened for that, whatever the layer asks for.
TEST(CompileScene, FindsWhatTheBaseOfALiveModelMustServe) {
    SceneFile scene = scene_of(
        {{.asked = {.a = 0, .b = 1, .effects = Ask::distance | Ask::tear}},
         {.asked = {.a = 1, .b = 1, .effects = Ask::collide | Ask::tear, .body = Body::solid}}});
    scene.changes = {{.deform = Twist{}}, {.tear = Tear{}}};
    for (FileObject& object : scene.objects) object.change = 0;
    const Plan::Compiled compiled = compile_scene(scene, kLimits);
    ASSERT_TRUE(compiled.plan);
    std::vector<ModelNeeds> needs = needs_of_models(scene, asks_of_layers(*compiled.plan));
    EXPECT_EQ(needs[0].asks, Ask::deform | Ask::solid);
    EXPECT_EQ(needs[1].asks, Ask::nothing) << "nobody asks for it";
    scene.objects[0].change = kUnchanged;
    scene.objects[1].change = 1;
    needs = needs_of_models(scene, asks_of_layers(*compiled.plan));
    EXPECT_EQ(needs[0].asks, Ask::tear | Ask::solid | Ask::distance);
}

// By hand: each pair of the layer of an object that changes must say so. Tear includes deform.
TEST(CompileScene, RefusesChangesThatNobodyAsksFor) {
    SceneFile scene = scene_of({{.asked = {.a = 0, .b = 1, .effects = Ask::distance}},
                                {.asked = {.a = 1, .b = 2, .effects = Ask::collide | Ask::deform}},
                                {.asked = {.a = 2, .b = 2, .effects = Ask::within | Ask::tear}},
                                {.asked = {.a = 0, .b = 2}}});
    scene.changes = {{.deform = Twist{}}, {.deform = Twist{}, .tear = Tear{}}};
    const auto refusals = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        scene.objects[0].change = x;
        scene.objects[1].change = y;
        scene.objects[2].change = z;
        Plan::Compiled compiled = compile_scene(scene, kLimits);
        EXPECT_EQ(compiled.plan.has_value(), compiled.refusals.empty());
        return std::move(compiled.refusals);
    };
    using Sentences = std::vector<std::string>;
    EXPECT_EQ(refusals(kUnchanged, kUnchanged, 0), Sentences{});
    EXPECT_EQ(refusals(0, kUnchanged, kUnchanged),
              Sentences{"s.json: Object 'x' in layer 'a' deforms. Add deform to the effects of "
                        "pair 0 of layers, 'a' and 'b'."});
    EXPECT_EQ(refusals(kUnchanged, 1, 1),
              (Sentences{"s.json: Object 'y' in layer 'b' tears. Add tear to the effects of pair 0 "
                         "of layers, 'a' and 'b'.",
                         "s.json: Object 'y' in layer 'b' tears. Add tear to the effects of pair 1 "
                         "of layers, 'b' and 'c'."}));
}

/// x and z are bodies, the second one with a mass. Layers a and b respond.
SceneFile scene_of_bodies() {
    SceneFile scene = scene_of({{.asked = {.a = 0, .b = 1, .effects = Ask::response}}});
    scene.bodies = {{}, {.mass = 2, .is_continuous = true}};
    scene.objects[0].body = 0;
    scene.objects[0].model = 1;
    return scene;
}

// The library computes no response: its plan is that of the other effects.
TEST(CompileScene, FindsWhatBodiesNeed) {
    SceneFile scene = scene_of_bodies();
    const Plan::Compiled compiled = compile_scene(scene, kLimits);
    ASSERT_TRUE(compiled.plan);
    EXPECT_TRUE(compiled.plan->pairs().empty());
    EXPECT_TRUE(is_asked(scene, *compiled.plan, scene.objects[0]));
    EXPECT_TRUE(is_asked(scene, *compiled.plan, scene.objects[1]));
    EXPECT_FALSE(is_asked(scene, *compiled.plan, scene.objects[2]));
    std::vector<ModelNeeds> needs = needs_of_models(scene, asks_of_layers(*compiled.plan));
    EXPECT_EQ(needs[0].asks, Ask::contacts | Ask::distance) << "a body is continuous";
    EXPECT_EQ(needs[0].wishes, Ask::solid);
    EXPECT_EQ(needs[1].asks, Ask::contacts | Ask::distance | Ask::response);
    scene.bodies[1].is_continuous = false;
    scene.objects[0].body = 1;
    needs = needs_of_models(scene, asks_of_layers(*compiled.plan));
    EXPECT_EQ(needs[0].asks, Ask::contacts);
    EXPECT_EQ(needs[1].asks, Ask::contacts);
    EXPECT_EQ(needs[1].wishes, Ask::solid | Ask::response) << "how its mass is distributed";
}

// By hand.
TEST(CompileScene, RefusesBodiesThatNothingPushes) {
    SceneFile scene = scene_of_bodies();
    scene.objects[2].body = 1;
    scene.changes = {{.deform = Twist{}}};
    scene.objects[1].change = 0;
    const Plan::Compiled compiled = compile_scene(scene, kLimits);
    EXPECT_FALSE(compiled.plan);
    const std::vector<std::string> expected = {
        "s.json: Object 'y' in layer 'b' deforms. Add deform to the effects of pair 0 of layers, "
        "'a' and 'b'.",
        "s.json: Object 'y' in layer 'b' deforms or tears. The response of such models is not "
        "supported: pieces do not follow the surface.",
        "s.json: Object 'z' in layer 'c' is a body, but no pair of this layer requests response."};
    EXPECT_EQ(compiled.refusals, expected);
}

TEST(DropEffect, LeavesBodiesWhereTheyAre) {
    SceneFile scene = scene_of_bodies();
    drop_effect(scene, Ask::response);
    EXPECT_EQ(scene.objects[0].body, kNoBody);
    EXPECT_TRUE(compile_scene(scene, kLimits).plan);
}

TEST(DropEffect, DropsAnErrorThatNoEffectReads) {
    SceneFile scene = scene_of({{.asked = {.a = 0,
                                           .b = 1,
                                           .effects = Ask::collide | Ask::distance,
                                           .max_distance = 1,
                                           .max_error = 0.5,
                                           .body = Body::solid}}});
    drop_effect(scene, Ask::collide);
    EXPECT_EQ(scene.pairs[0].asked.max_error, 0.5);
    EXPECT_TRUE(compile_scene(scene, kLimits).plan);
    drop_effect(scene, Ask::distance);
    EXPECT_EQ(scene.pairs[0].asked.max_error, 0);
    EXPECT_TRUE(compile_scene(scene, kLimits).plan);
}

// Pieces do not follow a surface that changes: the plan refuses the two together.
TEST(CompileScene, RefusesContactsOfModelsThatChange) {
    const SceneFile scene =
        scene_of({{.asked = {.a = 0, .b = 1, .effects = Ask::contacts | Ask::deform}}});
    const Plan::Compiled compiled = compile_scene(scene, kLimits);
    ASSERT_EQ(compiled.refusals.size(), 1u);
    EXPECT_NE(compiled.refusals[0].find("contacts is not supported for models that deform or tear"),
              std::string::npos)
        << compiled.refusals[0];
}

// pipeline_simulate compares them with the schema.
TEST(EffectWords, NameAllEffectsOfScenes) {
    const std::vector<std::string> words = effect_words();
    for (const Ask effect : kSceneEffects) {
        const std::string name = effect_name(effect);
        EXPECT_EQ(std::count(words.begin(), words.end(), name), 1) << name;
        EXPECT_EQ(effect_of(name), effect);
    }
}

}  // namespace
}  // namespace cdprep::scenes
