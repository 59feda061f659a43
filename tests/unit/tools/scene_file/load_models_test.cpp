// SPDX-License-Identifier: MIT
#include "scene_file/load_models.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace cdprep::scenes {
namespace {

constexpr const char* kTetrahedron =
    "OFF 4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

/// One object of a model for each layer 0 and 1, which ask about each other.
SceneFile scene_of(const std::filesystem::path& model, Ask effects) {
    SceneFile scene;
    scene.name = "s.json";
    scene.layers = {"a", "b", "c"};
    scene.pairs = {{.asked = {.a = 0, .b = 1, .effects = effects}}};
    scene.models = {model, "no/such/file.obj"};
    scene.motions = {Motion::fixed({})};
    scene.objects = {{.name = "x", .model = 0, .layer = 0},
                     {.name = "y", .model = 0, .layer = 1},
                     {.name = "z", .model = 1, .layer = 2}};
    return scene;
}

LoadedModels load_all(const SceneFile& scene, const LoadOptions& options = {}) {
    const cli::Threads threads(1);
    const auto compiled = compile_scene(scene, {.objects = 3, .pairs = 3});
    return load_models(scene, needs_of_models(scene, asks_of_layers(*compiled.plan)), options,
                       threads);
}

/// The models, or the first error.
Result<std::vector<SceneModel>> load(const SceneFile& scene, const LoadOptions& options = {}) {
    LoadedModels all = load_all(scene, options);
    if (!all.errors.empty()) return all.errors.front();
    return std::move(all.models);
}

TEST(LoadModels, BakesAMeshForExactlyThePlan) {
    const test::ScratchFolder folder;
    const auto mesh = folder.write("m.off", std::string_view(kTetrahedron));
    for (const Ask effects : {Ask::collide, Ask::within, Ask::collide | Ask::distance}) {
        const auto models = load(scene_of(mesh, effects));
        ASSERT_TRUE(models) << models.error().message;
        ASSERT_EQ(models->size(), 2u);
        const SceneModel& model = models->front();
        EXPECT_EQ(model.origin, ModelOrigin::in_memory);
        EXPECT_TRUE(model.model->serves(effects));
        EXPECT_EQ(model.model->sections().contains(SectionId::swept_nodes),
                  effects != Ask::collide);
        EXPECT_TRUE(sections_for(effects).contains(model.model->sections()));
        EXPECT_EQ(folder.names(), (std::set<std::string>{"m.off"}));
    }
}

// Its file does not even exist.
TEST(LoadModels, LeaveAModelAloneThatNobodyAsksFor) {
    const test::ScratchFolder folder;
    const auto models =
        load(scene_of(folder.write("m.off", std::string_view(kTetrahedron)), Ask::collide));
    ASSERT_TRUE(models);
    EXPECT_EQ(models->back().origin, ModelOrigin::unused);
    EXPECT_FALSE(models->back().model);
}

// Without a plan, a mesh is not even read.
TEST(LoadModels, OpenBakedFilesAlone) {
    const test::ScratchFolder folder;
    const auto mesh = folder.write("m.off", std::string_view("OFF 1 1 0\n"));
    LoadOptions options;
    options.bakes = false;
    const LoadedModels loaded = load_all(scene_of(mesh, Ask::collide), options);
    EXPECT_TRUE(loaded.errors.empty());
    ASSERT_EQ(loaded.models.size(), 2u);
    EXPECT_FALSE(loaded.models[0].model);
}

// One sentence: the layers, what they need, the sections, and a bake that keeps the rest.
TEST(ModelRefusals, AreOneSentenceForEachModel) {
    const test::ScratchFolder folder;
    const auto mesh = folder.write("m.off", std::string_view(kTetrahedron));
    SceneFile scene = scene_of(mesh, Ask::collide);
    LoadedModels loaded = load_all(scene);
    EXPECT_TRUE(model_refusals(scene, loaded.models).empty());
    // The same file in a scene that asks for more.
    scene = scene_of(mesh, Ask::within | Ask::distance);
    loaded.models[0].needs = needs_of_models(scene, asks_of_layers(scene))[0];
    EXPECT_EQ(model_refusals(scene, loaded.models),
              (std::vector<std::string>{
                  "s.json: " + mesh.string() +
                  ": its layers 'a' and 'b' need distance and within, but the file has no "
                  "source_triangle. Bake it again with --effects collide,distance,within."}));
}

TEST(LoadModels, AnswersAreThoseOfTheFile) {
    const test::ScratchFolder folder;
    const auto mesh = folder.write("m.off", std::string_view(kTetrahedron));
    const SceneFile scene = scene_of(mesh, Ask::collide | Ask::distance);
    LoadOptions options;
    options.cache = folder.path() / "cache";
    const auto in_memory = load(scene), cached = load(scene, options);
    ASSERT_TRUE(in_memory && cached);
    EXPECT_EQ(cached->front().origin, ModelOrigin::cached);
    const Model& a = *in_memory->front().model;
    const Model& b = *cached->front().model;
    EXPECT_EQ(a.header().content_hash, b.header().content_hash);
    EXPECT_EQ(a.sections(), b.sections());
}

TEST(LoadModels, BakesAgainAfterAChangeAndOnlyThen) {
    const test::ScratchFolder folder;
    const auto mesh = folder.write("m.off", std::string_view(kTetrahedron));
    LoadOptions options;
    options.cache = folder.path() / "cache";
    std::size_t stages = 0;
    options.begins = [&](std::size_t /*done*/, const std::string& /*what*/) { ++stages; };
    const auto bakes = [&](Ask effects) {
        stages = 0;
        EXPECT_TRUE(load(scene_of(mesh, effects), options));
        return stages > 0;
    };
    EXPECT_TRUE(bakes(Ask::collide));
    EXPECT_FALSE(bakes(Ask::collide));
    EXPECT_TRUE(bakes(Ask::within)) << "other effects";
    options.import.metres_per_unit = 0.001;
    EXPECT_TRUE(bakes(Ask::within)) << "another unit";
    folder.write("m.off", std::string(kTetrahedron) + "\n");
    EXPECT_TRUE(bakes(Ask::within)) << "another file";
    EXPECT_FALSE(bakes(Ask::within));
}

// A scene keeps colliders, and says so when it bakes the mesh.
TEST(LoadModels, TellsOfCollidersInAMesh) {
    const test::ScratchFolder folder;
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
        "o a\nf 1 3 2\nf 1 2 4\no UCX_a_00\nf 2 3 4\nf 3 1 4\n";
    const SceneFile scene = scene_of(folder.write("m.obj", std::string_view(text)), Ask::collide);
    LoadOptions options;
    options.cache = folder.path() / "cache";
    for (const bool is_first : {true, false}) {
        const auto models = load(scene, options);
        ASSERT_TRUE(models) << models.error().message;
        EXPECT_EQ(models->front().model->triangle_count(), 4U);
        const std::vector<std::string> lines = import_lines(scene, *models);
        ASSERT_EQ(lines.size(), is_first ? 1U : 0U);
        if (!is_first) continue;
        EXPECT_EQ(lines.front(),
                  scene.models[0].string() +
                      ": 1 collider is a part of the mesh: UCX_a_00. Leave it out by naming a "
                      "baked file.");
    }
}

// Parts of baked files are read only for an error of solids. A mesh has none.
TEST(UsesOfParts, TellModelsWithoutParts) {
    const test::ScratchFolder folder;
    SceneFile scene =
        scene_of(folder.write("m.off", std::string_view(kTetrahedron)), Ask::distance);
    LayerPair& pair = scene.pairs[0].asked;
    pair.max_error = 1;
    EXPECT_TRUE(uses_of_parts(scene).empty());
    pair.body = Body::solid;
    const std::vector<ModelUse> uses = uses_of_parts(scene);
    ASSERT_EQ(uses.size(), 2u);
    EXPECT_EQ(uses[0].layers, 0b11u);
    EXPECT_EQ(uses[1].layers, 0b100u) << "a file that does not exist";
    for (const ModelUse& use : uses) {
        EXPECT_EQ(use.parts.count, 0u);
        EXPECT_EQ(use.serves, known_asks());
    }
    const auto compiled = compile_scene(scene, {.objects = 3, .pairs = 3}, uses);
    ASSERT_TRUE(compiled.plan);
    EXPECT_EQ(compiled.plan->rungs()[0].rung, Rung::walk);
}

// The files that a mesh refers to decide its bake too.
TEST(LoadModels, BakesAgainAfterAChangeOfAnotherFile) {
    const test::ScratchFolder folder;
    const std::string gltf =
        R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"uri": "b.bin", "byteLength": 36}]})";
    const auto mesh = folder.write("m.gltf", std::string_view(gltf));
    LoadOptions options;
    options.cache = folder.path() / "cache";
    std::vector<std::uint64_t> hashes;
    for (const float size : {1.0f, 1.0f, 0.5f}) {
        const std::array<float, 9> corners = {0, 0, 0, size, 0, 0, 0, size, 0};
        folder.write("b.bin", std::as_bytes(std::span(corners)));
        const auto models = load(scene_of(mesh, Ask::collide), options);
        ASSERT_TRUE(models) << models.error().message;
        hashes.push_back(models->front().model->header().content_hash);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_NE(hashes[1], hashes[2]);
}

TEST(LoadModels, RefusesAnotherUnit) {
    const test::ScratchFolder folder;
    SceneFile scene = scene_of(folder.write("m.off", std::string_view(kTetrahedron)), Ask::collide);
    scene.metres_per_unit = 1;
    EXPECT_TRUE(load(scene)) << "a mesh without a unit has that of the scene";
    LoadOptions options;
    options.import.metres_per_unit = 0.001;
    const auto models = load(scene, options);
    ASSERT_FALSE(models);
    EXPECT_EQ(models.error().code, ErrorCode::bad_argument);
    EXPECT_NE(models.error().message.find("is in mm, but the unit of the scene is m"),
              std::string::npos)
        << models.error().message;
    scene.metres_per_unit = static_cast<double>(0.001F);
    EXPECT_TRUE(load(scene, options)) << "the same unit, rounded to a float";
}

TEST(LoadModels, NamesAMeshThatCannotBeRead) {
    const test::ScratchFolder folder;
    const auto models =
        load(scene_of(folder.write("m.off", std::string_view("OFF 1 1 0\n")), Ask::collide));
    ASSERT_FALSE(models);
    EXPECT_EQ(models.error().code, ErrorCode::unreadable);
    EXPECT_NE(models.error().message.find("m.off"), std::string::npos);
}

// The third model is one that nobody asks for, and the last one can be read.
TEST(LoadModels, NamesEveryModelThatCannotBeRead) {
    const test::ScratchFolder folder;
    SceneFile scene =
        scene_of(folder.write("m.off", std::string_view("OFF 1 1 0\n")), Ask::collide);
    scene.models.push_back(folder.write("n.off", std::string_view("OFF 2\n")));
    scene.models.push_back(folder.write("good.off", std::string_view(kTetrahedron)));
    scene.objects.push_back({.name = "v", .model = 2, .layer = 0});
    scene.objects.push_back({.name = "w", .model = 3, .layer = 0});
    const LoadedModels all = load_all(scene);
    ASSERT_EQ(all.errors.size(), 2u);
    EXPECT_NE(all.errors[0].message.find("m.off"), std::string::npos);
    EXPECT_NE(all.errors[1].message.find("n.off"), std::string::npos);
    ASSERT_EQ(all.models.size(), 4u) << "in the order of the scene";
    EXPECT_FALSE(all.models[0].model);
    EXPECT_TRUE(all.models[3].model);
}

}  // namespace
}  // namespace cdprep::scenes
