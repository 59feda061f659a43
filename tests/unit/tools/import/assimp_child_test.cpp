// SPDX-License-Identifier: MIT
#include "import/assimp_child.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cdprep/format/checksum.h"
#include "import/import_file.h"
#include "support/scratch_folder.h"

namespace cdprep::import {
namespace {

using mesh::Double3;
using mesh::Triangle;
using mesh::TriangleSoup;

/// A folder of its own for each test, removed at the end.
class AssimpChild : public testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        return scratch_.write(name, bytes);
    }

    const test::ScratchFolder scratch_;
};

/// A glTF file of one triangle in a separate buffer, used by the given nodes.
std::string gltf(const std::string& nodes, const std::string& buffer, int index_count = 3) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
           R"(],"meshes":[{"name":"m","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)" +
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)" +
           R"("min":[0,0,0],"max":[1,1,1]},{"bufferView":1,"componentType":5125,"count":)" +
           std::to_string(index_count) +
           R"(,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":36},)" +
           R"({"buffer":0,"byteOffset":36,"byteLength":12}],"buffers":[{"byteLength":48,"uri":")" +
           buffer + R"("}]})";
}

std::string triangle_buffer(std::uint32_t last_index = 2) {
    const float x[9] = {0, 0, 0, 0.1f, 0, 0, 0, 1, 0};
    const std::uint32_t index[3] = {0, 1, last_index};
    std::string bytes(48, '\0');
    std::memcpy(bytes.data(), x, 36);
    std::memcpy(bytes.data() + 36, index, 12);
    return bytes;
}

const char* const kTwoNodes = R"({"name":"root","children":[1],"translation":[1,2,3]},)"
                              R"({"name":"leaf","mesh":0,"scale":[-2,1,1]})";

TEST_F(AssimpChild, ReadsASceneWithItsTransformsAndUnits) {
    write("b.bin", triangle_buffer());
    const auto result = import_file(write("s.gltf", gltf(kTwoNodes, "b.bin")));
    ASSERT_TRUE(result.ok()) << result.error().message;
    const TriangleSoup& s = result.value();
    EXPECT_EQ(s.positions,
              (std::vector<Double3>{{1, 2, 3}, {-2 * double(0.1f) + 1, 2, 3}, {1, 3, 3}}));
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{0, 2, 1}}}));
    ASSERT_EQ(s.instances.size(), 1u);
    EXPECT_EQ(s.instances[0].flags, format::instance_mirrored);
    EXPECT_TRUE(s.instance_names[0].ends_with("root/leaf")) << s.instance_names[0];
    EXPECT_EQ(s.metres_per_unit, 1);
    EXPECT_EQ(s.up_axis, format::UpAxis::y);
    EXPECT_FALSE(s.single_precision);
}

/// An FBX file of one triangle with a unit of so many centimetres.
std::string fbx(const std::string& centimetres) {
    return "; FBX 7.3.0 project file\n"
           "FBXHeaderExtension: {\n FBXHeaderVersion: 1003\n FBXVersion: 7300\n}\n"
           "GlobalSettings: {\n Version: 1000\n Properties70: {\n"
           "  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," +
           centimetres +
           "\n }\n}\nDefinitions: {\n Version: 100\n Count: 2\n"
           " ObjectType: \"Model\" {\n  Count: 1\n }\n"
           " ObjectType: \"Geometry\" {\n  Count: 1\n }\n}\n"
           "Objects: {\n Geometry: 1000, \"Geometry::g\", \"Mesh\" {\n"
           "  Vertices: *9 {\n   a: 0,0,0,1,0,0,0,1,0\n  }\n"
           "  PolygonVertexIndex: *3 {\n   a: 0,1,-3\n  }\n  GeometryVersion: 124\n }\n"
           " Model: 2000, \"Model::m\", \"Mesh\" {\n  Version: 232\n }\n}\n"
           "Connections: {\n C: \"OO\",2000,0\n C: \"OO\",1000,2000\n}\n";
}

// assimp reads the unit as a float; these units are those of --unit, to the last bit.
TEST_F(AssimpChild, UnitsOfFbxAreNotRoundedToFloats) {
    const std::vector<std::pair<const char*, double>> units = {
        {"0.1", 0.001}, {"1", 0.01}, {"2.54", 0.0254}, {"30.48", 0.3048}, {"100", 1}};
    for (const auto& [centimetres, metres] : units) {
        const auto result = import_file(write("u.fbx", fbx(centimetres)));
        ASSERT_TRUE(result.ok()) << result.error().message;
        EXPECT_EQ(result.value().metres_per_unit, metres) << centimetres;
    }
}

TEST_F(AssimpChild, AnUntransformedSceneIsSingle) {
    write("b.bin", triangle_buffer());
    const auto result = import_file(write("s.gltf", gltf(R"({"name":"root","mesh":0})", "b.bin")));
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_TRUE(result.value().single_precision);
    EXPECT_EQ(result.value().positions[1].x, static_cast<double>(0.1f));
}

TEST_F(AssimpChild, AnIndexOutOfRangeIsNeverLost) {
    write("b.bin", triangle_buffer(7));
    const auto result = import_file(write("s.gltf", gltf(R"({"name":"root","mesh":0})", "b.bin")));
    ASSERT_TRUE(result.ok()) << result.error().message;
    ASSERT_EQ(result.value().bad_number_count, 1u);
    EXPECT_EQ(result.value().bad_numbers[0].found, 7);
    EXPECT_EQ(result.value().bad_numbers[0].limit, 3);
}

TEST_F(AssimpChild, FilesOutsideTheFolderAreNotRead) {
    std::filesystem::create_directory(scratch_.path() / "inner");
    write("b.bin", triangle_buffer());
    const std::string nodes = R"({"name":"root","mesh":0})";
    EXPECT_FALSE(import_file(write("inner/s.gltf", gltf(nodes, "../b.bin"))).ok());
    EXPECT_FALSE(
        import_file(write("inner/s.gltf", gltf(nodes, (scratch_.path() / "b.bin").string()))).ok());
    write("inner/b.bin", triangle_buffer());
    EXPECT_TRUE(import_file(write("inner/s.gltf", gltf(nodes, "b.bin"))).ok());
    EXPECT_TRUE(import_file(write("s.gltf", gltf(nodes, "inner/b.bin"))).ok());
}

TEST_F(AssimpChild, WhatItCannotReadIsOneSentence) {
    for (const char* content : {"", "x", "rubbish of no format at all\n", "{}", "<xml/>", "glTF"}) {
        for (const char* name : {"a.gltf", "a.glb", "a.dae", "a.fbx", "a.3ds", "a.xyz", "a"}) {
            const auto result = import_file(write(name, content));
            ASSERT_FALSE(result.ok()) << name << " '" << content << "'";
            EXPECT_EQ(result.error().code, ErrorCode::unreadable);
            const std::string& message = result.error().message;
            EXPECT_EQ(message.back(), '.') << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            EXPECT_NE(message.find(name), std::string::npos) << message;
        }
    }
}

TEST_F(AssimpChild, EveryFileThatWasReadIsHashed) {
    const std::string nodes = R"({"name":"root","mesh":0})";
    std::string bytes = triangle_buffer();
    std::filesystem::create_directory(scratch_.path() / "parts");
    write("parts/b.bin", bytes);
    const std::filesystem::path path = write("s.gltf", gltf(nodes, "parts/b.bin"));
    const auto before = import_file(path);
    bytes[0] ^= 1;
    write("parts/b.bin", bytes);
    const auto after = import_file(path);
    ASSERT_TRUE(before.ok() && after.ok());
    ASSERT_EQ(before->other_files.size(), 1u);
    EXPECT_EQ(before->other_files[0].name, "parts/b.bin");
    EXPECT_EQ(after->other_files[0].hash, format::checksum(std::as_bytes(std::span(bytes))));
    EXPECT_NE(before->other_files[0].hash, after->other_files[0].hash);
    EXPECT_EQ(before->source_hash, after->source_hash);
}

/// Position 1 of three zeros or buffered ones is replaced by (0, 1, 0).
std::string sparse_gltf(const std::string& base, const std::string& count) {
    return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
           R"("accessors":[{)" +
           base + R"("componentType":5126,"count":)" + count +
           R"(,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":1,"componentType":5125},)"
           R"("values":{"bufferView":2}}}],"bufferViews":[{"buffer":0,"byteLength":36},)"
           R"({"buffer":0,"byteOffset":40,"byteLength":4},{"buffer":0,"byteOffset":24,)"
           R"("byteLength":12}],"buffers":[{"byteLength":48,"uri":"b.bin"}]})";
}

TEST_F(AssimpChild, SparseAccessorsReplaceSomeElements) {
    write("b.bin", triangle_buffer());  // the index at byte 40 is 1
    const auto over_zeros = import_file(write("z.gltf", sparse_gltf("", "3")));
    ASSERT_TRUE(over_zeros.ok()) << over_zeros.error().message;
    EXPECT_EQ(over_zeros->positions, (std::vector<Double3>{{0, 0, 0}, {0, 1, 0}, {0, 0, 0}}));
    const auto over_others = import_file(write("o.gltf", sparse_gltf(R"("bufferView":0,)", "3")));
    ASSERT_TRUE(over_others.ok()) << over_others.error().message;
    EXPECT_EQ(over_others->positions, (std::vector<Double3>{{0, 0, 0}, {0, 1, 0}, {0, 1, 0}}));
    EXPECT_FALSE(import_file(write("one.gltf", sparse_gltf("", "1"))).ok());  // element 1 of 1
}

TEST_F(AssimpChild, ASparseAccessorAsksForNoMoreThanTheFileCanHold) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers need more memory than the limit that refuses this file";
#endif
    write("b.bin", triangle_buffer());
    const auto result = import_file(write("s.gltf", sparse_gltf("", "100000000")));
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::unreadable) << result.error().message;
    EXPECT_NE(result.error().message.find("a count in the file is wrong"), std::string::npos)
        << result.error().message;
}

TEST_F(AssimpChild, ExtensionsThatChangeTheGeometryAreRefusedByName) {
    write("b.bin", triangle_buffer());
    std::string text = gltf(R"({"name":"root","mesh":0})", "b.bin");
    text.insert(1, R"("extensionsRequired":["KHR_draco_mesh_compression"],)");
    const auto packed = import_file(write("s.gltf", text));
    ASSERT_FALSE(packed.ok());
    EXPECT_NE(packed.error().message.find("KHR_draco_mesh_compression"), std::string::npos);
    const auto instanced = import_file(write(
        "i.gltf",
        gltf(R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{}}}})", "b.bin")));
    ASSERT_FALSE(instanced.ok());
    EXPECT_NE(instanced.error().message.find("EXT_mesh_gpu_instancing"), std::string::npos);
}

TEST_F(AssimpChild, AMissingBufferAndACycleAreUnreadable) {
    const std::string nodes = R"({"name":"root","mesh":0})";
    const auto missing = import_file(write("s.gltf", gltf(nodes, "none.bin")));
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().code, ErrorCode::unreadable);
    EXPECT_NE(missing.error().message.find("none.bin"), std::string::npos)
        << missing.error().message;
    write("b.bin", triangle_buffer());
    const auto cyclic = import_file(
        write("s.gltf", gltf(R"({"children":[1],"mesh":0},{"children":[0]})", "b.bin")));
    ASSERT_FALSE(cyclic.ok());
    EXPECT_EQ(cyclic.error().code, ErrorCode::unreadable);
}

/// The same scene as one GLB file.
std::string glb() {
    std::string json = gltf(kTwoNodes, "");
    json.erase(json.find(R"(,"uri":"")"), 9);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string binary = triangle_buffer();
    const auto number = [](std::size_t value) {
        const auto word = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&word), 4);
    };
    return "glTF" + number(2) + number(12 + 8 + json.size() + 8 + binary.size()) +
           number(json.size()) + "JSON" + json + number(binary.size()) + std::string("BIN\0", 4) +
           binary;
}

TEST_F(AssimpChild, EveryTruncationOfAGlbIsUnreadable) {
    const std::string whole = glb();
    ASSERT_TRUE(import_file(write("s.glb", whole)).ok());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto result = import_file(write("s.glb", whole.substr(0, size)));
        ASSERT_FALSE(result.ok()) << size;
        EXPECT_EQ(result.error().code, ErrorCode::unreadable) << result.error().message;
    }
}

TEST_F(AssimpChild, FlippedBitsOfAGlbAreASoupOrASentence) {
    const std::string whole = glb();
    int soups = 0;
    for (std::size_t byte = 0; byte < whole.size(); ++byte) {
        std::string flipped = whole;
        flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << byte % 8));
        const auto result = import_file(write("s.glb", flipped));
        soups += result.ok();
        if (result.ok()) continue;
        EXPECT_EQ(result.error().code, ErrorCode::unreadable) << result.error().message;
        EXPECT_EQ(result.error().message.find("crashed"), std::string::npos)
            << result.error().message;
    }
    EXPECT_GT(soups, 50);
}

// Counts far beyond the buffer: whatever happens in the child, here it is one
// sentence, and soon.
TEST_F(AssimpChild, LyingCountsAreUnreadable) {
    write("b.bin", triangle_buffer());
    const std::string nodes = R"({"name":"root","mesh":0})";
    const auto begun = std::chrono::steady_clock::now();
    for (const int count : {6, 3000, 2'000'000'000}) {
        const auto result = import_file(write("s.gltf", gltf(nodes, "b.bin", count)));
        ASSERT_FALSE(result.ok()) << count;
        EXPECT_EQ(result.error().code, ErrorCode::unreadable) << result.error().message;
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(60));
}

/// A COLLADA file with that many triangles.
std::string collada(int triangles, const std::string& asset = "") {
    std::string points;
    std::string index;
    for (int i = 0; i < triangles + 2; ++i) points += std::to_string(i) + " 0 0.25 ";
    for (int i = 0; i < triangles; ++i) {
        for (int k = 0; k < 3; ++k) index += std::to_string(i + k) + " ";
    }
    const std::string values = std::to_string(3 * (triangles + 2));
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" )"
           R"(version="1.4.1"><asset>)" +
           asset +
           R"(</asset><library_geometries><geometry id="g" )"
           R"(name="g"><mesh><source id="p"><float_array id="a" count=")" +
           values + R"(">)" + points +
           R"(</float_array><technique_common><accessor source="#a" count=")" +
           std::to_string(triangles + 2) +
           R"(" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>)"
           R"(<param name="Z" type="float"/></accessor></technique_common></source>)"
           R"(<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)"
           R"(<triangles count=")" +
           std::to_string(triangles) + R"("><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
           index +
           R"(</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>)"
           R"(<visual_scene id="s"><node id="n" name="n"><instance_geometry url="#g"/></node>)"
           R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>)"
           R"(</COLLADA>)";
}

/// The text of collada(1), with a further element in its node.
std::string collada_with(const std::string& element) {
    std::string text = collada(1);
    return text.insert(text.find(R"(<instance_geometry url="#g"/>)"), element);
}

TEST_F(AssimpChild, ColladaTellsUnitAndUpAxisAndIsNotTurned) {
    const auto plain = import_file(write("a.dae", collada(1)));
    ASSERT_TRUE(plain.ok()) << plain.error().message;
    EXPECT_EQ(plain.value().metres_per_unit, 1);
    EXPECT_EQ(plain.value().up_axis, format::UpAxis::y);
    const auto inches = import_file(
        write("b.dae", collada(1, R"(<unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis>)")));
    ASSERT_TRUE(inches.ok()) << inches.error().message;
    EXPECT_EQ(inches.value().metres_per_unit, 0.0254);
    EXPECT_EQ(inches.value().up_axis, format::UpAxis::z);
    EXPECT_EQ(inches.value().positions, plain.value().positions);
    EXPECT_EQ(plain.value().positions[1], (Double3{1, 0, 0.25}));
    for (const char* asset :
         {"<unit\n meter = '0.0254' name='inch' /><up_axis >Z_UP</up_axis>",
          "<unit name='a > b' meter\t= \" 0.0254 \"/><up_axis\n> Z_UP </up_axis>",
          "<unit name = 'meter=\"3\"' meter=\"0.0254\"/><up_axis>\nZ_UP</up_axis>"}) {
        const auto spaced = import_file(write("c.dae", collada(1, asset)));
        ASSERT_TRUE(spaced.ok()) << spaced.error().message;
        EXPECT_EQ(spaced->metres_per_unit, 0.0254) << asset;
        EXPECT_EQ(spaced->up_axis, format::UpAxis::z) << asset;
    }
}

TEST_F(AssimpChild, APartOfAnotherColladaFileIsNamed) {
    for (const char* reference :
         {R"(<instance_geometry url="arm.dae#g"/>)", "<instance_node\n url = 'arm.dae#g'/>",
          R"(<instance_geometry name="a>b" url="arm.dae#g"/>)"}) {
        const auto result = import_file(write("a.dae", collada_with(reference)));
        ASSERT_FALSE(result.ok()) << reference;
        EXPECT_EQ(result.error().code, ErrorCode::unreadable);
        EXPECT_NE(result.error().message.find("arm.dae#g"), std::string::npos)
            << result.error().message;
    }
}

TEST_F(AssimpChild, APartOfAColladaFileThatIsMissingIsNamed) {
    for (const char* reference :
         {R"(<instance_geometry url="#gone"/>)", R"(<instance_node url="#gone"/>)"}) {
        const auto result = import_file(write("a.dae", collada_with(reference)));
        ASSERT_FALSE(result.ok()) << reference;
        EXPECT_EQ(result.error().code, ErrorCode::unreadable);
        EXPECT_NE(result.error().message.find("gone"), std::string::npos) << result.error().message;
    }
    // Light is no part of a mesh.
    const auto lit = import_file(write("a.dae", collada_with(R"(<instance_light url="#gone"/>)")));
    EXPECT_TRUE(lit.ok()) << lit.error().message;
}

/// The text of collada(1), with a skin of one joint that is 5 away.
std::string skinned_collada() {
    const auto source = [](const std::string& id, const std::string& values,
                           const std::string& stride, const std::string& parameter) {
        return "<source id=\"" + id + "\">" + values + R"(<technique_common><accessor source="#)" +
               id + R"(a" count="1" stride=")" + stride + R"("><param )" + parameter +
               "/></accessor></technique_common></source>";
    };
    const std::string controllers =
        R"(<library_controllers><controller id="c"><skin source="#g">)" +
        source("j", R"(<Name_array id="ja" count="1">bone</Name_array>)", "1",
               R"(name="JOINT" type="name")") +
        source("b",
               R"(<float_array id="ba" count="16">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array>)",
               "16", R"(name="TRANSFORM" type="float4x4")") +
        source("w", R"(<float_array id="wa" count="1">1</float_array>)", "1",
               R"(name="WEIGHT" type="float")") +
        R"(<joints><input semantic="JOINT" source="#j"/>)"
        R"(<input semantic="INV_BIND_MATRIX" source="#b"/></joints><vertex_weights count="3">)"
        R"(<input semantic="JOINT" source="#j" offset="0"/>)"
        R"(<input semantic="WEIGHT" source="#w" offset="1"/>)"
        R"(<vcount>1 1 1</vcount><v>0 0 0 0 0 0</v></vertex_weights></skin></controller>)"
        "</library_controllers>";
    std::string text = collada_with(
        R"(<instance_controller url="#c"><skeleton>#bone</skeleton></instance_controller>)"
        R"(<node id="bone" sid="bone" name="bone" type="JOINT"><translate>5 0 0</translate></node>)");
    const std::string plain = R"(<instance_geometry url="#g"/>)";
    text.replace(text.find(plain), plain.size(), "");
    return text.insert(text.find("<library_visual_scenes>"), controllers);
}

TEST_F(AssimpChild, ASkinIsNotAppliedButTold) {
    const auto plain = import_file(write("a.dae", collada(1)));
    const auto skinned = import_file(write("b.dae", skinned_collada()));
    ASSERT_TRUE(plain.ok() && skinned.ok()) << skinned.error().message;
    EXPECT_TRUE(plain->remarks.empty());
    EXPECT_EQ(skinned->remarks,
              (std::vector<std::string>{"1 mesh has a skin or morph weights, which are not "
                                        "applied: vertices stay as stored."}));
    EXPECT_EQ(skinned->positions, plain->positions);
}

// assimp would make a mesh of the bones.
TEST_F(AssimpChild, BonesWithoutAMeshHaveNoTriangles) {
    const auto result = import_file(
        write("a.bvh",
              "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
              "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n"));
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message.find("no triangles"), std::string::npos)
        << result.error().message;
}

TEST_F(AssimpChild, TooLittleMemoryIsOverBudgetForAnHonestFile) {
    const std::filesystem::path path = write("a.dae", collada(200'000));
    ImportOptions options;
    options.memory_bytes = 48 << 20;
    const auto result = import_file(path, options);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::over_budget) << result.error().message;
#endif
    EXPECT_TRUE(import_file(path).ok());
}

TEST_F(AssimpChild, TooLittleTimeIsOverBudget) {
    ImportOptions options;
    options.time = std::chrono::seconds(0);
    const auto result = import_file(write("a.dae", collada(200'000)), options);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::over_budget);
}

TEST_F(AssimpChild, ManyImportsLeaveNoDescriptorsAndNoChildren) {
    write("b.bin", triangle_buffer());
    const std::filesystem::path path =
        write("s.gltf", gltf(R"({"name":"root","mesh":0})", "b.bin"));
    const auto count = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                             std::filesystem::directory_iterator());
    };
    const auto before = count();
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(import_file(path).ok());
    EXPECT_EQ(count(), before);
}

}  // namespace
}  // namespace cdprep::import
