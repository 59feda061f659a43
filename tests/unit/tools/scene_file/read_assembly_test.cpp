// SPDX-License-Identifier: MIT
// The files are read by the importing child.
#include "scene_file/read_assembly.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene_file/load_models.h"
#include "support/scratch_folder.h"

namespace cdprep::scenes {
namespace {

using import::Affine;

constexpr Affine kNone = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// A glTF file of two meshes, of a triangle each.
class GltfFolder {
public:
    std::filesystem::path write(const std::string& nodes) const {
        const std::array<float, 12> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
        std::string bytes(sizeof points, '\0');
        std::memcpy(bytes.data(), points.data(), bytes.size());
        folder_.write("buffer.bin", bytes);
        const std::string accessor = R"("componentType":5126,"count":3,"type":"VEC3"})";
        return folder_.write(
            "a.gltf",
            R"({"asset":{"version":"2.0"},"nodes":[)" + nodes +
                R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},)" +
                R"({"primitives":[{"attributes":{"POSITION":1}}]}],"accessors":[{"bufferView":0,)" +
                accessor + R"(,{"bufferView":0,"byteOffset":12,)" + accessor +
                R"(],"bufferViews":[{"buffer":0}],"buffers":[{"uri":"buffer.bin"}]})");
    }
    [[nodiscard]] AssemblyScene read(const std::string& nodes) const {
        Result<AssemblyScene> scene = read_assembly(write(nodes), {});
        if (!scene) throw std::runtime_error(scene.error().message);
        return std::move(scene).value();
    }
    [[nodiscard]] const test::ScratchFolder& scratch() const {
        return folder_;
    }

private:
    test::ScratchFolder folder_;
};

std::vector<std::uint32_t> models_of(const SceneFile& scene) {
    std::vector<std::uint32_t> models;
    for (const FileObject& object : scene.objects) models.push_back(object.model);
    return models;
}

Pose pose_at(const SceneFile& scene, std::size_t object) {
    return *pose_of(scene, scene.objects[object], 0);
}

TEST(ReadAssembly, RigidTransformsArePoses) {
    const GltfFolder folder;
    const AssemblyScene read =
        folder.read(R"({"mesh":0,"name":"a"},{"mesh":1,"name":"b","translation":[1,2,3]},)"
                    R"({"mesh":0,"name":"a","matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,7,8,9,1]})");
    const SceneFile& scene = read.scene;
    EXPECT_EQ(scene.layers, std::vector<std::string>{"objects"});
    EXPECT_EQ(models_of(scene), (std::vector<std::uint32_t>{0, 1, 0}));
    EXPECT_EQ(scene.objects[2].name, "a#2");
    EXPECT_EQ(pose_at(scene, 1).translation(), (Double3{1, 2, 3}));
    EXPECT_EQ(pose_at(scene, 2).rotation(), (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
    EXPECT_EQ(pose_at(scene, 2).translation(), (Double3{7, 8, 9}));
    EXPECT_EQ(read.models[0][0].model_from_mesh, kNone);
    EXPECT_EQ(read.rounding, 0);
    const auto soup =
        read.file.triangles(std::array{import::PlacedNode{&read.file.nodes()[1], kNone}});
    ASSERT_TRUE(soup);
    EXPECT_EQ(soup->positions[2], (Double3{0, 0, 1}));
    EXPECT_TRUE(soup->single_precision);
    EXPECT_EQ(soup->metres_per_unit, 1);
    EXPECT_EQ(soup->other_files.at(0).name, "buffer.bin");
    EXPECT_NE(soup->other_files[0].hash, 0u);
}

// By hand: 0.6 and 0.8 as floats deviate by some 1e-8, and a length of 1.00001 by 2e-5.
TEST(ReadAssembly, TheRoundingOfFloatsIsNoScale) {
    const GltfFolder folder;
    const AssemblyScene read = folder.read(
        R"({"mesh":0},{"mesh":0,"rotation":[0.6000000238418579,0,0,0.800000011920929]},)"
        R"({"mesh":0,"scale":[1.00001,1.00001,1.00001]})");
    EXPECT_EQ(models_of(read.scene), (std::vector<std::uint32_t>{0, 0, 1}));
    EXPECT_GT(read.rounding, 1e-9);
    EXPECT_LT(read.rounding, 1e-6);
    const std::array<double, 9> r = pose_at(read.scene, 1).rotation();
    EXPECT_NEAR(r[4], 0.28, 1e-7);
    EXPECT_NEAR(r[7], 0.96, 1e-7);
    EXPECT_NEAR(pose_at(read.scene, 2).rotation()[0], 1, 1e-15);
    EXPECT_NEAR(read.models[1][0].model_from_mesh[0], 1.00001, 1e-12);
}

// A parent's scale moves its children too.
TEST(ReadAssembly, AUniformScaleIsInTheModel) {
    const GltfFolder folder;
    const AssemblyScene read = folder.read(
        R"({"children":[1,2],"scale":[0.001,0.001,0.001]},{"mesh":0,"translation":[1000,0,0]},)"
        R"({"mesh":0,"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,0,2000,0,1]})");
    EXPECT_EQ(models_of(read.scene), (std::vector<std::uint32_t>{0, 0}));
    EXPECT_NEAR(read.models[0][0].model_from_mesh[0], 0.001, 1e-18);
    EXPECT_EQ(pose_at(read.scene, 0).translation(), (Double3{1, 0, 0}));
    EXPECT_NEAR(pose_at(read.scene, 1).rotation()[3], 1, 1e-15);
    EXPECT_EQ(pose_at(read.scene, 1).translation(), (Double3{0, 2, 0}));
}

TEST(ReadAssembly, OtherTransformsAreInTheModelWhole) {
    const GltfFolder folder;
    const AssemblyScene read = folder.read(
        R"({"mesh":0,"scale":[-1,1,1]},{"mesh":0,"scale":[-1,1,1],"translation":[5,0,0]},)"
        R"({"mesh":0,"scale":[1,2,1]},{"mesh":1,"scale":[1,2,1]},{"mesh":0,"scale":[0,0,0]},)"
        R"({"mesh":0,"matrix":[1,0,0,0,0.5,1,0,0,0,0,1,0,0,0,0,1]},)"
        R"({"mesh":0,"scale":[-2,-2,-2]})");
    EXPECT_EQ(models_of(read.scene), (std::vector<std::uint32_t>{0, 0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(pose_at(read.scene, 1).translation(), (Double3{5, 0, 0}));
    EXPECT_EQ(pose_at(read.scene, 1).rotation(), Pose().rotation());
    EXPECT_EQ(read.models[4][0].model_from_mesh, (Affine{1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
    const auto mirrored = read.file.triangles(
        std::array{import::PlacedNode{&read.file.nodes()[0], read.models[0][0].model_from_mesh}});
    ASSERT_TRUE(mirrored);
    EXPECT_EQ(mirrored->positions[1], (Double3{-1, 0, 0}));
    EXPECT_EQ(mirrored->triangles[0], (mesh::Triangle{{0, 2, 1}}));
}

TEST(ReadAssembly, RefusesWhatIsNoAssembly) {
    const GltfFolder folder;
    const auto refused = [&](const std::string& nodes, const std::string& words) {
        const auto read = read_assembly(folder.write(nodes), {});
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().code, ErrorCode::unreadable);
        EXPECT_NE(read.error().message.find(words), std::string::npos) << read.error().message;
    };
    refused(R"({"name":"camera"})", "a.gltf: has no node with triangles.");
    refused(R"({"mesh":0,"name":"far","translation":[0,1e302,0]})",
            "the transform of node 'far' has the number 1e+302; at most 1.07");
    EXPECT_FALSE(read_assembly(folder.scratch().path() / "none.glb", {}));
}

TEST(ReadAssembly, GltfIsToldByNameOrMagic) {
    const test::ScratchFolder folder;
    EXPECT_TRUE(is_assembly("no/such/file.glb"));
    EXPECT_TRUE(is_assembly("no/such/file.gltf"));
    EXPECT_TRUE(is_assembly(folder.write("binary", std::string_view("glTF\2\0\0\0", 8))));
    EXPECT_FALSE(is_assembly(folder.write("scene.json", std::string_view("{}"))));
}

// Two instances and a scaled copy are two models, and two files in a cache.
TEST(ReadAssembly, ModelsAreBakedOnce) {
    const GltfFolder folder;
    AssemblyScene read =
        folder.read(R"({"mesh":0},{"mesh":0,"translation":[1,0,0]},{"mesh":0,"scale":[2,2,2]})");
    read.scene.pairs = {{.asked = {.a = 0, .b = 0, .effects = Ask::collide}}};
    const cli::Threads threads(1);
    const std::vector<ModelNeeds> needs = needs_of_models(read.scene, asks_of_layers(read.scene));
    LoadOptions options;
    options.assembly = &read;
    const auto in_memory = load_models(read.scene, needs, options, threads);
    options.cache = folder.scratch().path() / "cache";
    const auto cached = load_models(read.scene, needs, options, threads);
    const auto again = load_models(read.scene, needs, options, threads);
    for (const LoadedModels* loaded : {&in_memory, &cached, &again}) {
        ASSERT_TRUE(loaded->errors.empty()) << loaded->errors[0].message;
        ASSERT_EQ(loaded->models.size(), 2u);
    }
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(cached.models[i].needs.objects, i == 0 ? 2u : 1u);
        EXPECT_EQ(cached.models[i].origin, ModelOrigin::cached);
        const std::uint64_t hash = in_memory.models[i].model->header().content_hash;
        EXPECT_EQ(cached.models[i].model->header().content_hash, hash);
        EXPECT_EQ(again.models[i].model->header().content_hash, hash);
    }
    EXPECT_NE(cached.models[0].model->header().content_hash,
              cached.models[1].model->header().content_hash);
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(options.cache)) {
        ++files;
    }
    EXPECT_EQ(files, 2u);
}

}  // namespace
}  // namespace cdprep::scenes
