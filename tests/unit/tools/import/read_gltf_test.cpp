// SPDX-License-Identifier: MIT
// What a glTF file may hold, number by number. The files are read by the importing child.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "import/import_file.h"
#include "support/scratch_folder.h"

namespace cdprep::import {
namespace {

using mesh::Double3;
using mesh::Triangle;
using mesh::TriangleSoup;

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// Five points, of which no three are in line.
const std::vector<float> kPoints = {0, 0, 0, 1, 0, 0, 0, 1, 0, 3, 2, 0, 1, 5, 0.25f};

/// A glTF file of parts that a test replaces. Its buffer is `buffer.bin`.
struct Document {
    std::string nodes = R"({"mesh":0})";
    std::string primitives = R"({"attributes":{"POSITION":0}})";
    std::string accessors = R"({"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"})";
    std::string views = R"({"buffer":0})";
    std::string buffers = R"({"uri":"buffer.bin"})";
    std::string mesh;  ///< more members of the mesh, each begun by a comma
    std::string more;  ///< more members of the file, likewise

    [[nodiscard]] std::string text() const {
        return R"({"asset":{"version":"2.0"},"nodes":[)" + nodes +
               R"(],"meshes":[{"primitives":[)" + primitives + "]" + mesh + R"(}],"accessors":[)" +
               accessors + R"(],"bufferViews":[)" + views + R"(],"buffers":[)" + buffers + "]" +
               more + "}";
    }
};

class ReadGltf : public testing::Test {
protected:
    Result<TriangleSoup> read(const Document& document,
                              const std::string& buffer = bytes_of(kPoints)) const {
        scratch_.write("buffer.bin", buffer);
        return import_file(scratch_.write("a.gltf", document.text()));
    }

    /// Expects a refusal with these words.
    void expect_refused(const Document& document, const std::string& words,
                        const std::string& buffer = bytes_of(kPoints)) const {
        const auto result = read(document, buffer);
        ASSERT_FALSE(result.ok()) << words;
        EXPECT_EQ(result.error().code, ErrorCode::unreadable);
        EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
    }

    /// The points and triangles of one primitive with these members.
    void expect_triangles(const std::string& members, const std::vector<Triangle>& expected) const {
        Document document;
        document.primitives = R"({"attributes":{"POSITION":0})" + members + "}";
        const auto soup = read(document);
        ASSERT_TRUE(soup.ok()) << soup.error().message;
        EXPECT_EQ(soup->triangles, expected) << members;
        EXPECT_EQ(soup->positions.size(), 5u);
    }

    const test::ScratchFolder scratch_;
};

TEST_F(ReadGltf, AModeSaysWhichCornersAreATriangle) {
    const std::vector<Triangle> list = {{{0, 1, 2}}};  // the last two corners make none
    expect_triangles("", list);
    expect_triangles(R"(,"mode":4)", list);
    expect_triangles(R"(,"mode":5)", {{{0, 1, 2}}, {{1, 3, 2}}, {{2, 3, 4}}});
    expect_triangles(R"(,"mode":6)", {{{0, 1, 2}}, {{0, 2, 3}}, {{0, 3, 4}}});
}

TEST_F(ReadGltf, PointsAndLinesAreNoTriangles) {
    for (const char* mode : {"0", "1", "2", "3", "7"}) {
        Document document;
        document.primitives = R"({"attributes":{"POSITION":0}},{"attributes":{"POSITION":0},)"
                              R"("mode":)" +
                              std::string(mode) + R"(},{"attributes":{}})";
        const auto soup = read(document);
        ASSERT_TRUE(soup.ok()) << soup.error().message;
        EXPECT_EQ(soup->triangles.size(), 1u) << mode;
    }
}

TEST_F(ReadGltf, BuffersMayBeWrittenInTheFile) {
    const std::vector<std::string> texts = {
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAQEAAAAAA+/8+fw==",
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAQEAAAAAA+/8="};
    for (const std::string& text : texts) {
        Document document;
        document.accessors = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})";
        document.buffers = R"({"uri":"data:application/octet-stream;base64,)" + text + R"("})";
        const auto soup = read(document);
        ASSERT_TRUE(soup.ok()) << soup.error().message;
        EXPECT_EQ(soup->positions, (std::vector<Double3>{{0, 0, 0}, {1, 0, 0}, {0, 3, 0}}));
        EXPECT_TRUE(soup->other_files.empty());
    }
    // The digits + and / and all 64 values: two points of bytes.
    Document document;
    document.accessors =
        R"({"bufferView":0,"componentType":5121,"count":3,"type":"VEC3","byteOffset":1})";
    document.buffers = R"({"uri":"data:,+/8+fwAZaz9A4b8="})";
    const auto soup = read(document);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->positions, (std::vector<Double3>{{255, 62, 127}, {0, 25, 107}, {63, 64, 225}}));
}

TEST_F(ReadGltf, EveryDigitOfBase64HasItsValue) {
    // Six bits each, in order: 0, 1, 2 ... 63.
    std::string bytes;
    for (unsigned four = 0; four < 64; four += 4) {
        const unsigned bits = four << 18 | (four + 1) << 12 | (four + 2) << 6 | (four + 3);
        for (const unsigned shift : {16U, 8U, 0U}) bytes += static_cast<char>(bits >> shift);
    }
    Document document;
    document.accessors = R"({"bufferView":0,"componentType":5121,"count":16,"type":"VEC3"})";
    document.buffers = R"({"uri":"data:,ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz)"
                       R"(0123456789+/"})";
    const auto soup = read(document);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    ASSERT_EQ(soup->positions.size(), 16u);
    const auto at = [&](std::size_t i) {
        return static_cast<double>(static_cast<std::uint8_t>(bytes[i]));
    };
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(soup->positions[i], (Double3{at(3 * i), at(3 * i + 1), at(3 * i + 2)})) << i;
    }
}

TEST_F(ReadGltf, ElementsMayLieApartFromOffsetsOn) {
    // Two bytes of another view, two of the view; then a point and four bytes of something else.
    std::string bytes = "....";
    for (int i = 0; i < 3; ++i) {
        bytes += bytes_of(std::vector<float>(kPoints.begin() + 3 * i, kPoints.begin() + 3 * i + 3));
        if (i < 2) bytes += "rest";  // the last element needs none
    }
    Document document;
    document.views = R"({"buffer":0,"byteOffset":2,"byteStride":16})";
    const std::string accessor =
        R"({"bufferView":0,"byteOffset":2,"componentType":5126,"type":"VEC3","count":)";
    document.accessors = accessor + "3}";
    const auto soup = read(document, bytes);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->positions, (std::vector<Double3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    expect_refused(document,
                   "accessor 0 declares 3 elements from byte 4 of buffer 0, which has 47 bytes",
                   bytes.substr(0, 47));
    document.accessors = accessor + "4}";
    expect_refused(document, "accessor 0 declares 4 elements from byte 4", bytes);
    document.accessors = accessor + "3}";
    document.views = R"({"buffer":0,"byteOffset":2,"byteStride":11})";
    expect_refused(document, "accessor 0 has elements that overlap", bytes);
    document.views = R"({"buffer":0,"byteOffset":47})";
    expect_refused(document, "from byte 49 of buffer 0, which has 48 bytes", bytes);
    document.accessors = R"({"bufferView":0,"byteOffset":1,"componentType":5126,"type":"VEC3",)"
                         R"("count":0})";
    EXPECT_NE(read(document, bytes).error().message.find("no triangle"), std::string::npos);
}

TEST_F(ReadGltf, IntegersAreNumbersOrPartsOfTheirLimit) {
    struct Case {
        const char* type;
        std::string bytes;
        std::array<double, 9> plain;
        double limit;
    };
    const std::vector<Case> cases = {
        {"5120",
         bytes_of<std::int8_t>({-128, -127, 0, 1, 64, 127, 5, 6, 7}),
         {-128, -127, 0, 1, 64, 127, 5, 6, 7},
         127},
        {"5121",
         bytes_of<std::uint8_t>({0, 1, 2, 127, 128, 255, 5, 6, 7}),
         {0, 1, 2, 127, 128, 255, 5, 6, 7},
         255},
        {"5122",
         bytes_of<std::int16_t>({-32768, -32767, 0, 1, 300, 32767, 5, 6, 7}),
         {-32768, -32767, 0, 1, 300, 32767, 5, 6, 7},
         32767},
        {"5123",
         bytes_of<std::uint16_t>({0, 1, 300, 32767, 32768, 65535, 5, 6, 7}),
         {0, 1, 300, 32767, 32768, 65535, 5, 6, 7},
         65535}};
    for (const Case& each : cases) {
        for (const bool normalized : {false, true}) {
            Document document;
            document.accessors = R"({"bufferView":0,"count":3,"type":"VEC3","componentType":)" +
                                 std::string(each.type) +
                                 (normalized ? R"(,"normalized":true})" : "}");
            const auto soup = read(document, each.bytes);
            ASSERT_TRUE(soup.ok()) << soup.error().message;
            for (std::size_t i = 0; i < 9; ++i) {
                const Double3& p = soup->positions[i / 3];
                const double found = std::array{p.x, p.y, p.z}[i % 3];
                const float part =
                    static_cast<float>(each.plain[i]) / static_cast<float>(each.limit);
                EXPECT_EQ(found, normalized ? std::max<double>(part, -1) : each.plain[i])
                    << each.type << ", " << i;
            }
        }
    }
}

TEST_F(ReadGltf, IndicesHaveOneTwoOrFourBytes) {
    const std::vector<std::pair<const char*, std::string>> cases = {
        {"5121", bytes_of<std::uint8_t>({4, 0, 200})},
        {"5123", bytes_of<std::uint16_t>({4, 0, 60000})},
        {"5125", bytes_of<std::uint32_t>({4, 0, 70000})}};
    for (const auto& [type, bytes] : cases) {
        Document document;
        document.accessors += R"(,{"bufferView":1,"count":3,"type":"SCALAR","componentType":)" +
                              std::string(type) + "}";
        document.views += R"(,{"buffer":0,"byteOffset":60})";
        document.primitives = R"({"attributes":{"POSITION":0},"indices":1})";
        const auto soup = read(document, bytes_of(kPoints) + bytes);
        ASSERT_TRUE(soup.ok()) << soup.error().message;
        ASSERT_EQ(soup->bad_number_count, 1u) << type;
        EXPECT_EQ(soup->bad_numbers[0].limit, 5);
        const std::string last = std::to_string(soup->bad_numbers[0].found);
        EXPECT_EQ(last, std::string(type) == "5121"   ? "200"
                        : std::string(type) == "5123" ? "60000"
                                                      : "70000");
        std::string good = bytes;
        good.replace(good.size() * 2 / 3, std::string::npos, good.size() / 3, '\0');
        good[good.size() * 2 / 3] = 2;
        const auto right = read(document, bytes_of(kPoints) + good);
        ASSERT_TRUE(right.ok()) << right.error().message;
        EXPECT_EQ(right->triangles, (std::vector<Triangle>{{{4, 0, 2}}})) << type;
    }
}

TEST_F(ReadGltf, WhatAnAccessorMayNotBeIsNamed) {
    const std::string index = R"(,{"bufferView":0,"componentType":5123,"count":3,"type":"SCALAR")";
    Document indexed;
    indexed.primitives = R"({"attributes":{"POSITION":0},"indices":1})";
    const auto with_index = [&](const std::string& text) {
        Document document = indexed;
        document.accessors += text;
        return document;
    };
    expect_refused(with_index(""), "accessor 1 does not exist");
    expect_refused(
        with_index(R"(,{"bufferView":0,"componentType":5126,"count":3,"type":"SCALAR"})"),
        "an index has component type 5126");
    expect_refused(with_index(R"(,{"bufferView":0,"componentType":5123,"count":3,"type":"VEC2"})"),
                   "accessor 1 is not a SCALAR");
    expect_refused(with_index(index + R"(,"sparse":{}})"), "accessor 1 of indices is sparse");
    expect_refused(with_index(R"(,{"componentType":5123,"count":3,"type":"SCALAR"})"),
                   "accessor 1 has no data");

    const auto with = [](const std::string& accessor) {
        Document document;
        document.accessors = accessor;
        return document;
    };
    expect_refused(with(""), "accessor 0 does not exist");
    expect_refused(with(R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC4"})"),
                   "accessor 0 is not a VEC3");
    expect_refused(with(R"({"bufferView":0,"componentType":5124,"count":3,"type":"VEC3"})"),
                   "component type 5124 is not a type of glTF");
    expect_refused(with(R"({"bufferView":0,"componentType":5125,"count":3,"type":"VEC3"})"),
                   "a number has component type 5125");
    for (const char* count : {"-1", "2.5", "\"3\"", "9007199254740994"}) {
        expect_refused(with(R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
                            std::string(count) + "}"),
                       "'count' is not a whole number");
    }
    expect_refused(with(R"({"bufferView":0,"componentType":5126,"type":"VEC3",)"
                        R"("count":9007199254740992})"),
                   "accessor 0 declares 9007199254740992 elements");
    Document nowhere;
    nowhere.views = R"({"buffer":1})";
    expect_refused(nowhere, "accessor 0 is in a buffer that does not exist");
    nowhere.views = "";
    expect_refused(nowhere, "accessor 0 is in a buffer that does not exist");
}

TEST_F(ReadGltf, NodesTurnThenScaleInTheirOwnAxes) {
    const auto placed = [&](const std::string& members) {
        Document document;
        document.nodes = R"({"mesh":0,)" + members + "}";
        return read(document)->positions[4];  // of (1, 5, 0.25)
    };
    constexpr double kSlack = 8e-15;  // a quarter of a turn has no exact quaternion
    const auto near = [&](const Double3& p, const Double3& q) {
        EXPECT_NEAR(p.x, q.x, kSlack);
        EXPECT_NEAR(p.y, q.y, kSlack);
        EXPECT_NEAR(p.z, q.z, kSlack);
    };
    const std::string half = "0.70710678118654757";
    near(placed(R"("rotation":[)" + half + ",0,0," + half + "]"), {1, -0.25, 5});
    near(placed(R"("rotation":[0,)" + half + ",0," + half + "]"), {0.25, 5, -1});
    near(placed(R"("rotation":[0,0,)" + half + "," + half + "]"), {-5, 1, 0.25});
    // All four numbers at once: a third of a turn about (1, 1, 1), and x, y, z go to y, z, x.
    near(placed(R"("rotation":[0.5,0.5,0.5,0.5])"), {0.25, 1, 5});
    near(placed(R"("rotation":[-0.5,0.5,0.5,0.5])"), {-5, 0.25, -1});
    near(placed(R"("rotation":[0.5,-0.5,0.5,0.5])"), {-5, -0.25, 1});
    near(placed(R"("rotation":[0.5,0.5,-0.5,0.5])"), {5, -0.25, -1});
    EXPECT_EQ(placed(R"("translation":[10,20,30])"), (Double3{11, 25, 30.25}));
    EXPECT_EQ(placed(R"("scale":[2,3,4])"), (Double3{2, 15, 1}));
    near(placed(R"("translation":[10,20,30],"scale":[2,3,4],"rotation":[0.5,0.5,0.5,0.5])"),
         {11, 22, 45});
    // A matrix is written column by column.
    EXPECT_EQ(placed(R"("matrix":[0,2,0,0,0,0,3,0,4,0,0,0,10,20,30,1])"), (Double3{11, 22, 45}));
}

TEST_F(ReadGltf, NodesAreReadFromTheChosenScene) {
    Document document;
    const auto moved = [](int x, const std::string& more = "") {
        return R"({"mesh":0,"translation":[)" + std::to_string(x) + ",0,0]" + more + "}";
    };
    document.nodes = moved(100) + "," + moved(200) + "," +
                     R"({"translation":[1000,0,0],"children":[0,4]},)" + moved(300) + "," +
                     moved(400);
    const auto starts = [&](const std::string& more) {
        document.more = more;
        std::vector<double> found;
        const auto soup = read(document);
        if (!soup) return found;
        for (std::size_t i = 0; i < soup->positions.size(); i += 5) {
            found.push_back(soup->positions[i].x);
        }
        return found;
    };
    // Depth first; without scenes from all nodes that are no children.
    EXPECT_EQ(starts(""), (std::vector<double>{200, 1100, 1400, 300}));
    const std::string scenes = R"(,"scenes":[{"nodes":[3,1]},{"nodes":[2]}])";
    EXPECT_EQ(starts(scenes), (std::vector<double>{300, 200}));
    EXPECT_EQ(starts(scenes + R"(,"scene":1)"), (std::vector<double>{1100, 1400}));
    document.more = scenes + R"(,"scene":2)";
    expect_refused(document, "its scene does not exist");
    document.more = R"(,"scenes":[{"nodes":[5]}])";
    expect_refused(document, "node 5 does not exist");
    document.more = "";
    document.nodes = R"({"mesh":1})";
    expect_refused(document, "mesh 1 does not exist");
    document.nodes = R"({"children":[1]},{"children":[2]},{"children":[1],"mesh":0})";
    expect_refused(document, "is its own descendant");
    document.nodes = R"({"children":[1]},{"children":[2]},{"mesh":0})";  // as deep as can be
    EXPECT_TRUE(read(document).ok());
}

TEST_F(ReadGltf, PrimitivesKeepMaterialsAndNodesNames) {
    Document document;
    document.nodes = R"({"mesh":0,"children":[1]},{"name":"arm","mesh":0})";
    document.primitives = R"({"attributes":{"POSITION":0},"material":1},)"
                          R"({"attributes":{"POSITION":0},"material":0})";
    document.more = R"(,"materials":[{"name":"steel"},{}])";
    const auto soup = read(document);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->instance_names, (std::vector<std::string>{"node_0", "node_0/arm"}));
    ASSERT_EQ(soup->materials.runs.size(), 4u);
    const auto& names = soup->materials.names;
    ASSERT_EQ(names.size(), 2u);
    EXPECT_EQ(names[soup->materials.runs[0].name], "material_1");
    EXPECT_EQ(names[soup->materials.runs[1].name], "steel");
}

TEST_F(ReadGltf, AFileInConflictEndsTheImport) {
    scratch_.write("kept.bin", bytes_of(kPoints));
    Document document;
    document.buffers = R"({"uri":"kept.bin"})";
    const auto path = scratch_.write("kept.gltf", document.text());
    ImportOptions options;
    options.find_conflict = [](const std::filesystem::path& file) -> std::optional<Error> {
        if (file.filename() != "kept.bin") return std::nullopt;
        return Error{ErrorCode::bad_argument, "kept.bin is an output."};
    };
    const auto soup = import_file(path, options);
    ASSERT_FALSE(soup.ok());
    EXPECT_EQ(soup.error().code, ErrorCode::bad_argument);
}

TEST_F(ReadGltf, NamesOfFilesMayBeEscaped) {
    scratch_.write("my buffer%.bin", bytes_of(kPoints));
    Document document;
    document.buffers = R"({"uri":"my%20buffer%.bin"})";
    const auto soup = read(document);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    ASSERT_EQ(soup->other_files.size(), 1u);
    EXPECT_EQ(soup->other_files[0].name, "my buffer%.bin");
    scratch_.write("twice%2", bytes_of(kPoints));
    document.buffers = R"({"uri":"twice%2"})";
    EXPECT_TRUE(read(document).ok());
    document.buffers = R"({"uri":"buffer.bin"},{"uri":"gone.bin"})";
    expect_refused(document, "buffer 1, gone.bin, cannot be opened or is not in the file's folder");
}

TEST_F(ReadGltf, SeveralBuffersKeepTheirBytes) {
    // Short texts live inside a string object, which moves when the list of buffers grows.
    Document document;
    document.buffers = R"({"uri":"data:,AAECAwQFBgcI"},{"uri":"data:,AgEAAA=="},)"
                       R"({"uri":"buffer.bin"},{"uri":"data:,AAAA"})";
    document.views = R"({"buffer":0},{"buffer":1})";
    document.accessors = R"({"bufferView":0,"componentType":5121,"count":3,"type":"VEC3"},)"
                         R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"})";
    document.primitives = R"({"attributes":{"POSITION":0},"indices":1})";
    const auto soup = read(document);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->positions, (std::vector<Double3>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}));
    EXPECT_EQ(soup->triangles, (std::vector<Triangle>{{{2, 1, 0}}}));
}

TEST_F(ReadGltf, ExtensionsOfAppearanceAreHarmless) {
    for (const char* name : {"KHR_mesh_quantization", "KHR_lights_punctual", "KHR_materials_unlit",
                             "KHR_texture_transform", "EXT_texture_webp"}) {
        Document document;
        document.more = R"(,"extensionsRequired":[")" + std::string(name) + R"("])";
        EXPECT_TRUE(read(document).ok()) << name;
    }
}

// A view of 36 bytes holds 3 points of 12 bytes; its buffer holds 5.
TEST_F(ReadGltf, AnAccessorStaysInItsBufferView) {
    Document document;
    const auto with = [&](const char* count, const char* view) {
        document.accessors = R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
                             std::string(count) + "}";
        document.views = R"({"buffer":0,)" + std::string(view) + "}";
        return document;
    };
    EXPECT_TRUE(read(with("3", R"("byteLength":36)")).ok());
    expect_refused(
        with("4", R"("byteLength":36)"),
        "accessor 0 declares 4 elements from byte 0 of buffer view 0, which has 36 bytes");
    expect_refused(
        with("3", R"("byteLength":36,"byteStride":16)"),
        "accessor 0 declares 3 elements from byte 0 of buffer view 0, which has 36 bytes");
    EXPECT_TRUE(read(with("3", R"("byteLength":36,"byteOffset":24)")).ok());
    expect_refused(with("3", R"("byteLength":36,"byteOffset":25)"),
                   "buffer view 0 declares 36 bytes from byte 25 of buffer 0, which has 60 bytes");
    expect_refused(with("3", R"("byteLength":0,"byteOffset":61)"),
                   "buffer view 0 declares 0 bytes from byte 61 of buffer 0, which has 60 bytes");
}

/// A target that moves point 1 by 10 in x, and one that moves point 4 by (1, 2, 4).
struct MorphDocument : Document {
    MorphDocument() {
        accessors += R"(,{"bufferView":1,"componentType":5126,"count":5,"type":"VEC3"},)"
                     R"({"componentType":5126,"count":5,"type":"VEC3","sparse":{"count":1,)"
                     R"("indices":{"bufferView":2,"componentType":5121},)"
                     R"("values":{"bufferView":3}}})";
        views += R"(,{"buffer":0,"byteOffset":60,"byteLength":60},)"
                 R"({"buffer":0,"byteOffset":132,"byteLength":1},)"
                 R"({"buffer":0,"byteOffset":120,"byteLength":12})";
        primitives = R"({"attributes":{"POSITION":0},)"
                     R"("targets":[{"POSITION":1},{"NORMAL":1},{"POSITION":2}]})";
    }

    [[nodiscard]] static std::string buffer() {
        std::vector<float> offsets(15);
        offsets[3] = 10;
        return bytes_of(kPoints) + bytes_of(offsets) + bytes_of<float>({1, 2, 4}) +
               bytes_of<std::uint8_t>({4});
    }
};

// Sums of a few bits, computed by hand.
TEST_F(ReadGltf, MorphTargetsMoveVerticesByTheirWeights) {
    MorphDocument document;
    const auto points = [&](const std::string& node, const std::string& mesh) {
        document.nodes = R"({"mesh":0)" + node + "}";
        document.mesh = mesh;
        const auto soup = read(document, MorphDocument::buffer());
        EXPECT_TRUE(soup.ok()) << soup.error().message;
        return soup.ok() ? soup->positions : std::vector<Double3>();
    };
    const std::vector<Double3> plain = points("", "");
    EXPECT_EQ(plain[1], (Double3{1, 0, 0}));
    std::vector<Double3> moved = plain;
    moved[1] = {6, 0, 0};
    moved[4] = {0.75, 4.5, -0.75};
    EXPECT_EQ(points("", R"(,"weights":[0.5,7,-0.25])"), moved);
    EXPECT_EQ(points(R"(,"weights":[0.5,7,-0.25])", R"(,"weights":[1,1,1])"), moved)
        << "the weights of the node win";
    EXPECT_EQ(points(R"(,"weights":[0,0,0])", R"(,"weights":[1,1,1])"), plain);
    EXPECT_EQ(points("", R"(,"weights":[0,1])"), plain) << "a target without positions";
}

TEST_F(ReadGltf, EachNodeHasItsOwnWeights) {
    MorphDocument document;
    document.nodes = R"({"mesh":0},{"mesh":0,"weights":[1]},{"mesh":0,"weights":[1]})";
    const auto soup = read(document, MorphDocument::buffer());
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    ASSERT_EQ(soup->instances.size(), 3u);
    EXPECT_EQ(soup->instances[1].mesh, soup->instances[2].mesh);
    EXPECT_NE(soup->instances[0].mesh, soup->instances[1].mesh);
    EXPECT_EQ(soup->positions[1].x, 1);
    EXPECT_EQ(soup->positions[6].x, 11);
    EXPECT_EQ(soup->positions[11].x, 11);
    EXPECT_FALSE(soup->single_precision);
    document.nodes = R"({"mesh":0,"weights":[0,0,0]})";
    EXPECT_TRUE(read(document, MorphDocument::buffer())->single_precision);
}

// The second target has no data, which means zeros.
TEST_F(ReadGltf, AMorphTargetWithoutDataMovesNothing) {
    MorphDocument document;
    document.mesh = R"(,"weights":[0.5,0.5])";
    document.primitives = R"({"attributes":{"POSITION":0},"targets":[{"POSITION":1},)"
                          R"({"POSITION":3}]})";
    const std::string accessors = document.accessors;
    const auto with_count = [&](const char* count) {
        document.accessors =
            accessors + R"(,{"componentType":5126,"type":"VEC3","count":)" + count + "}";
        return document;
    };
    const auto soup = read(with_count("5"), MorphDocument::buffer());
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->positions[1], (Double3{6, 0, 0}));
    EXPECT_EQ(soup->positions[4], (Double3{1, 5, 0.25}));
    expect_refused(with_count("9007199254740992"),
                   "has 5 vertices, but its morph target has 9007199254740992",
                   MorphDocument::buffer());
}

// Compressed meshes have such positions, and are not read.
TEST_F(ReadGltf, PositionsWithoutDataAreRefused) {
    Document document;
    document.accessors = R"({"componentType":5126,"count":5,"type":"VEC3"})";
    expect_refused(document, "accessor 0 has no data");
}

TEST_F(ReadGltf, MorphTargetsThatDoNotFitAreNamed) {
    MorphDocument document;
    document.mesh = R"(,"weights":[0,0,0,1])";
    expect_refused(document, "primitive 0 of mesh 0 has 3 morph targets, but number 4 has a weight",
                   MorphDocument::buffer());
    document.mesh = R"(,"weights":[1])";
    document.accessors = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
                         R"({"bufferView":1,"componentType":5126,"count":5,"type":"VEC3"})";
    expect_refused(document, "primitive 0 of mesh 0 has 4 vertices, but its morph target has 5",
                   MorphDocument::buffer());
}

/// A skin of two joints: node 1 moves by 10 in x, and node 2 below it by 20 in y. Vertices of
/// joint 1 first move by 5 in z. The node of the mesh has a scale that must not count.
struct SkinDocument : Document {
    SkinDocument() {
        nodes = R"({"mesh":0,"skin":0,"scale":[100,100,100]},)"
                R"({"translation":[10,0,0],"children":[2]},{"translation":[0,20,0]})";
        accessors += R"(,{"bufferView":1,"componentType":5121,"count":5,"type":"VEC4"},)"
                     R"({"bufferView":2,"componentType":5126,"count":5,"type":"VEC4"},)"
                     R"({"bufferView":3,"componentType":5126,"count":2,"type":"MAT4"})";
        views += R"(,{"buffer":0,"byteOffset":60,"byteLength":20},)"
                 R"({"buffer":0,"byteOffset":80,"byteLength":80},)"
                 R"({"buffer":0,"byteOffset":160,"byteLength":128})";
        primitives = R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}})";
        more = R"(,"skins":[{"joints":[1,2],"inverseBindMatrices":3}])";
    }

    /// Points 0, 3 and 4 follow joint 0, point 1 joint 1, and point 2 both. The weights of point 3
    /// have the sum 0.25. Unused places have joint 9.
    [[nodiscard]] static std::string buffer() {
        std::vector<float> matrices(32);
        for (const std::size_t i : {0, 5, 10, 15}) matrices[i] = matrices[16 + i] = 1;
        matrices[16 + 14] = 5;  // column by column
        return bytes_of(kPoints) + bytes_of<std::uint8_t>({0, 9, 9, 9, 9, 1, 9, 9, 0, 1,
                                                           9, 9, 0, 9, 9, 9, 9, 9, 9, 0}) +
               bytes_of<float>(
                   {1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0, 0.25f, 0, 0, 0, 0, 0, 0, 1}) +
               bytes_of(matrices);
    }
};

TEST_F(ReadGltf, SkinsPlaceVerticesByTheirJoints) {
    const auto soup = read(SkinDocument(), SkinDocument::buffer());
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(
        soup->positions,
        (std::vector<Double3>{{10, 0, 0}, {11, 20, 5}, {10, 11, 2.5}, {13, 2, 0}, {11, 5, 0.25}}));
    EXPECT_EQ(soup->triangles, (std::vector<Triangle>{{{0, 1, 2}}}));
    ASSERT_EQ(soup->instances.size(), 1u);
    EXPECT_EQ(soup->instances[0].model_from_node,
              (std::array<double, 12>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
    EXPECT_TRUE(soup->remarks.empty());
}

TEST_F(ReadGltf, NodesBelowASkinnedNodeMoveWithIt) {
    SkinDocument document;
    document.nodes.replace(document.nodes.find(R"("scale")"), 0, R"("children":[3],)");
    document.nodes += R"(,{"mesh":0,"translation":[1,0,0]})";
    const auto soup = read(document, SkinDocument::buffer());
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    ASSERT_EQ(soup->positions.size(), 10u);
    EXPECT_EQ(soup->positions[0], (Double3{10, 0, 0}));
    EXPECT_EQ(soup->positions[6], (Double3{200, 0, 0}));
}

TEST_F(ReadGltf, ASkinWithoutMatricesHasJointsAtTheOrigin) {
    SkinDocument document;
    document.more = R"(,"skins":[{"joints":[1,2]}])";
    const auto soup = read(document, SkinDocument::buffer());
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->positions[1], (Double3{11, 20, 0}));
    EXPECT_EQ(soup->positions[2], (Double3{10, 11, 0}));
}

TEST_F(ReadGltf, ASkinMovesWhatMorphTargetsMadeInAnySetOfJoints) {
    SkinDocument document;
    document.primitives = R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":4,)"
                          R"("JOINTS_1":1,"WEIGHTS_1":2},"targets":[{"POSITION":0}]})";
    document.accessors += R"(,{"bufferView":4,"componentType":5126,"count":5,"type":"VEC4"})";
    document.views += R"(,{"buffer":0,"byteOffset":288,"byteLength":80})";
    document.mesh = R"(,"weights":[1])";
    const auto soup = read(document, SkinDocument::buffer() + std::string(80, '\0'));
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(
        soup->positions,
        (std::vector<Double3>{{10, 0, 0}, {12, 20, 5}, {10, 12, 2.5}, {16, 4, 0}, {12, 10, 0.5}}));
}

// The points are mirrored, and so would be the sides of their triangles.
TEST_F(ReadGltf, JointsThatMirrorReverseTriangles) {
    SkinDocument document;
    document.nodes.replace(document.nodes.find("[10,0,0]"), 8, R"([10,0,0],"scale":[-1,1,1])");
    const auto soup = read(document, SkinDocument::buffer());
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->positions[1], (Double3{9, 20, 5}));
    EXPECT_EQ(soup->triangles, (std::vector<Triangle>{{{0, 2, 1}}}));
}

TEST_F(ReadGltf, ASkinThatDoesNotFitIsNamed) {
    const auto refused = [&](const std::string& old, const std::string& now, const char* words) {
        SkinDocument document;
        for (std::string* part : {&document.more, &document.primitives, &document.accessors}) {
            if (const std::size_t at = part->find(old); at != std::string::npos) {
                part->replace(at, old.size(), now);
            }
        }
        expect_refused(document, words, SkinDocument::buffer());
    };
    refused(R"([{"joints")", R"([],"s":[{"joints")", "skin 0 does not exist");
    refused("[1,2]", "[1,7]", "skin 0 has the joint 7, which is no node below a root");
    refused("[1,2]", "[1]", "primitive 0 of mesh 0 uses joint 1, but its skin has 1 joints");
    refused("[1,2]", "[1,2,1]", "skin 0 has 3 joints, but 2 inverse bind matrices");
    refused(R"("JOINTS_0":1,)", "", "primitive 0 of mesh 0 has a skin, but no JOINTS_0");
    refused(R"(,"WEIGHTS_0":2)", "", "primitive 0 of mesh 0 has a skin, but no WEIGHTS_0");
    refused(R"(5121,"count":5)", R"(5121,"count":4)",
            "primitive 0 of mesh 0 has 5 vertices, but its JOINTS_0 has 4");
}

/// The buffer of a SkinDocument, with these weights at point 2 and none at point 4.
std::string skin_with_weights(const std::vector<float>& weights) {
    std::string buffer = SkinDocument::buffer();
    buffer.replace(80 + 2 * 16, 16, bytes_of(weights));
    buffer.replace(80 + 4 * 16, 16, 16, '\0');
    return buffer;
}

// The first joint of point 4 is 9, which does not exist, and then 0.
TEST_F(ReadGltf, AVertexWithoutWeightsFollowsItsFirstJoint) {
    std::string buffer = skin_with_weights({0, 0, 0, 0});
    buffer.replace(60 + 16, 4, 4, '\0');
    const auto soup = read(SkinDocument(), buffer);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(
        soup->positions,
        (std::vector<Double3>{{10, 0, 0}, {11, 20, 5}, {10, 1, 0}, {13, 2, 0}, {11, 5, 0.25}}));
    EXPECT_EQ(soup->remarks,
              (std::vector<std::string>{"2 vertices of skins have no joint weights: they follow "
                                        "their first joints."}));
    expect_refused(SkinDocument(), "uses joint 9, but its skin has 2 joints",
                   skin_with_weights({0, 0, 0, 0}));
}

TEST_F(ReadGltf, JointWeightsWithoutAPositiveSumAreRefused) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    for (const std::vector<float>& weights : std::vector<std::vector<float>>{
             {-1, 0.5f, 0, 0}, {-1, 1, 0, 0}, {kNaN, 0, 0, 0}, {1, kNaN, 0, 0}}) {
        expect_refused(SkinDocument(), "has joint weights at vertex 2 whose sum is not above 0",
                       skin_with_weights(weights).replace(60 + 16, 4, 4, '\0'));
    }
}

TEST_F(ReadGltf, TextMayBeInAnotherEncodingAndDeepToALimit) {
    Document document;
    document.nodes = "{\"mesh\":0,\"name\":\"caf\xe9\"}";
    const auto soup = read(document);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->instance_names[0], "caf\xef\xbf\xbd");
    document.nodes = R"({"mesh":0})";
    document.more = R"(,"extras":)" + std::string(99, '[') + std::string(99, ']');
    EXPECT_TRUE(read(document).ok());
    document.more = R"(,"extras":)" + std::string(101, '[') + std::string(101, ']');
    expect_refused(document, "its JSON is nested deeper than 100 levels");
    document.more = ",";
    expect_refused(document, "its JSON is invalid at byte ");
}

}  // namespace
}  // namespace cdprep::import
