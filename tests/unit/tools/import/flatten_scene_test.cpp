// SPDX-License-Identifier: MIT
#include "import/flatten_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace cdprep::import {
namespace {

using mesh::Double3;
using mesh::Triangle;
using mesh::TriangleSoup;

using Matrix = std::array<double, 16>;
constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

struct MeshPart {
    std::vector<std::array<double, 3>> vertices;
    std::vector<std::vector<std::uint32_t>> faces;
    std::uint32_t material = 0;
    bool is_single = true;
};

struct NodePart {
    std::string name;
    std::uint32_t parent = kNoParent;
    Matrix matrix = kIdentity;
    std::vector<std::uint32_t> meshes;
    bool is_posed = false;
};

/// What the child would write.
class Bytes {
public:
    Bytes(const std::vector<MeshPart>& meshes, const std::vector<NodePart>& nodes,
          const std::vector<std::string>& materials = {}) {
        header.magic = kSceneMagic;
        header.outcome = SceneOutcome::read;
        header.mesh_count = meshes.size();
        header.node_count = nodes.size();
        header.material_count = materials.size();
        for (const MeshPart& mesh : meshes) {
            SceneMesh counts{};
            counts.vertex_count = mesh.vertices.size();
            counts.face_count = mesh.faces.size();
            for (const auto& face : mesh.faces) counts.corner_count += face.size();
            counts.material = mesh.material;
            counts.is_single = mesh.is_single ? 1 : 0;
            add(counts);
            header.vertex_count += counts.vertex_count;
            header.face_count += counts.face_count;
            header.corner_count += counts.corner_count;
        }
        for (const NodePart& node : nodes) {
            SceneNode part{};
            std::copy(node.matrix.begin(), node.matrix.end(), part.parent_from_node.begin());
            part.parent = node.parent;
            part.mesh_count = static_cast<std::uint32_t>(node.meshes.size());
            part.name_bytes = static_cast<std::uint32_t>(node.name.size());
            part.is_posed = node.is_posed ? 1 : 0;
            add(part);
            header.node_mesh_count += node.meshes.size();
        }
        for (const NodePart& node : nodes) {
            for (const std::uint32_t mesh : node.meshes) add(mesh);
        }
        for (const std::string& name : materials) add(static_cast<std::uint32_t>(name.size()));
        for (const MeshPart& mesh : meshes) {
            for (const auto& p : mesh.vertices) {
                for (const double x : p) add(x);
            }
        }
        for (const MeshPart& mesh : meshes) {
            for (const auto& face : mesh.faces) add(static_cast<std::uint32_t>(face.size()));
        }
        for (const MeshPart& mesh : meshes) {
            for (const auto& face : mesh.faces) {
                for (const std::uint32_t corner : face) add(corner);
            }
        }
        for (const NodePart& node : nodes) add_text(node.name);
        for (const std::string& name : materials) add_text(name);
    }

    [[nodiscard]] std::vector<std::byte> whole() const {
        std::vector<std::byte> all(sizeof header + arrays.size());
        std::memcpy(all.data(), &header, sizeof header);
        std::copy(arrays.begin(), arrays.end(), all.begin() + sizeof header);
        return all;
    }

    SceneHeader header{};
    std::vector<std::byte> arrays;

private:
    template <class T>
    void add(const T& value) {
        const auto* raw = reinterpret_cast<const std::byte*>(&value);
        arrays.insert(arrays.end(), raw, raw + sizeof value);
    }
    void add_text(const std::string& text) {
        for (const char c : text) add(c);
        header.text_bytes += text.size();
    }
};

Result<TriangleSoup> flatten(const std::vector<std::byte>& bytes,
                             const ImportOptions& options = {}) {
    return flatten_scene(SourceFile("t.glb", "x"), bytes, options);
}

const MeshPart kTriangle = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}, 0};

Matrix moved(double x, double y, double z, double scale_x = 1) {
    Matrix m = kIdentity;
    m[0] = scale_x;
    m[3] = x, m[7] = y, m[11] = z;
    return m;
}

TEST(FlattenScene, NodesTransformTheirMeshesAlongThePath) {
    const Bytes bytes({kTriangle}, {{"root", kNoParent, moved(10, 0, 0), {}},
                                    {"arm", 0, moved(0, 20, 0), {0}},
                                    {"hand", 1, moved(0, 0, 30, 2), {0}}});
    const auto result = flatten(bytes.whole());
    ASSERT_TRUE(result.ok()) << result.error().message;
    const TriangleSoup& s = result.value();
    EXPECT_EQ(
        s.positions,
        (std::vector<Double3>{
            {11, 20, 0}, {10, 21, 0}, {10, 20, 1}, {12, 20, 30}, {10, 21, 30}, {10, 20, 31}}));
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{0, 1, 2}}, {{3, 4, 5}}}));
    EXPECT_FALSE(s.single_precision);
    EXPECT_EQ(s.instance_names, (std::vector<std::string>{"root/arm", "root/arm/hand"}));
    ASSERT_EQ(s.instances.size(), 2u);
    EXPECT_EQ(s.instances[1].mesh, 0u);
    EXPECT_EQ(s.instances[1].name, 1u);
    EXPECT_EQ(s.instances[1].first_triangle, 1u);
    EXPECT_EQ(s.instances[1].triangle_count, 1u);
    EXPECT_EQ(s.instances[1].model_from_node,
              (std::array<double, 12>{2, 0, 0, 10, 0, 1, 0, 20, 0, 0, 1, 30}));
}

TEST(FlattenScene, ASkinPlacesMeshesButNotTheNodesBelow) {
    const Bytes bytes({kTriangle}, {{"skin", kNoParent, moved(10, 0, 0, -1), {0}, true},
                                    {"hand", 0, moved(0, 20, 0), {0}}});
    const auto result = flatten(bytes.whole());
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_EQ(result->positions,
              (std::vector<Double3>{
                  {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {9, 20, 0}, {10, 21, 0}, {10, 20, 1}}));
    EXPECT_EQ(result->triangles, (std::vector<Triangle>{{{0, 1, 2}}, {{3, 5, 4}}}));
    EXPECT_EQ(result->instances[0].flags, 0u);
}

TEST(FlattenScene, MeshesThatAreNotPosedAreTold) {
    Bytes bytes({kTriangle}, {{"root", kNoParent, kIdentity, {0}}});
    EXPECT_TRUE(flatten(bytes.whole())->remarks.empty());
    bytes.header.unposed_meshes = 2;
    EXPECT_EQ(flatten(bytes.whole())->remarks,
              (std::vector<std::string>{"2 meshes have a skin or morph weights, which are not "
                                        "applied: vertices stay as stored."}));
}

TEST(FlattenScene, VerticesWithoutJointWeightsAreTold) {
    Bytes bytes({kTriangle}, {{"root", kNoParent, kIdentity, {0}}});
    bytes.header.weightless_vertices = 1;
    EXPECT_EQ(flatten(bytes.whole())->remarks,
              (std::vector<std::string>{
                  "1 vertex of a skin has no joint weights: it follows its first joint."}));
    bytes.header.weightless_vertices = 3;
    EXPECT_EQ(flatten(bytes.whole())->remarks,
              (std::vector<std::string>{
                  "3 vertices of skins have no joint weights: they follow their first joints."}));
}

// The same scene as parts: each node with its own place, geometry without it.
TEST(PlacedScene, MeshNodesStayApart) {
    const MeshPart points = {{{0, 0, 0}}, {{0}}, 0};
    const std::vector<std::byte> bytes =
        Bytes({kTriangle, points}, {{"root", kNoParent, moved(10, 0, 0), {1}},
                                    {"arm", 0, moved(0, 20, 0), {0, 1}},
                                    {"hand", 1, moved(0, 0, 30, 2), {0}}})
            .whole();
    const SourceFile file("t.glb", "x");
    const auto scene = PlacedScene::make(file, bytes);
    ASSERT_TRUE(scene) << scene.error().message;
    const std::vector<MeshNode> nodes = scene->mesh_nodes();
    ASSERT_EQ(nodes.size(), 2u) << "points are no triangles";
    EXPECT_EQ(nodes[0].path, "root/arm");
    EXPECT_EQ(nodes[1].path, "root/arm/hand");
    EXPECT_EQ(nodes[0].meshes, std::vector<std::uint32_t>{0});
    EXPECT_EQ(nodes[1].meshes, nodes[0].meshes);
    EXPECT_EQ(nodes[1].world_from_node, (Affine{2, 0, 0, 10, 0, 1, 0, 20, 0, 0, 1, 30}));
    const Affine none = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const auto plain = scene->flatten_nodes(std::array{PlacedNode{&nodes[1], none}}, {});
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->positions, (std::vector<Double3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_TRUE(plain->single_precision);
    EXPECT_EQ(plain->instance_names, std::vector<std::string>{"root/arm/hand"});
    const auto mirrored = scene->flatten_nodes(
        std::array{PlacedNode{&nodes[1], {-3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}}, {});
    ASSERT_TRUE(mirrored);
    EXPECT_EQ(mirrored->positions, (std::vector<Double3>{{-3, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(mirrored->triangles, (std::vector<Triangle>{{{0, 2, 1}}}));
    EXPECT_FALSE(mirrored->single_precision);
}

TEST(FlattenScene, IdentityKeepsFloats) {
    const auto result = flatten(Bytes({kTriangle}, {{"a", kNoParent, kIdentity, {0, 0}}}).whole());
    ASSERT_TRUE(result.ok());
    EXPECT_TRUE(result.value().single_precision);
    EXPECT_EQ(result.value().instances.size(), 2u);
    EXPECT_EQ(result.value().instance_names.size(), 1u);
}

// Mirroring turns the triangle inside out; the winding is turned with it.
TEST(FlattenScene, MirroredNodesKeepOutwardOutward) {
    const MeshPart quad = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}}, 0};
    const auto result = flatten(Bytes({quad}, {{"a", kNoParent, moved(0, 0, 0, -1), {0}},
                                               {"b", 0, moved(0, 0, 0, -1), {0}}})
                                    .whole());
    ASSERT_TRUE(result.ok());
    const TriangleSoup& s = result.value();
    EXPECT_EQ(s.instances[0].flags, format::instance_mirrored);
    EXPECT_EQ(s.instances[1].flags, 0u);
    EXPECT_EQ(s.triangles,
              (std::vector<Triangle>{{{0, 3, 2}}, {{0, 2, 1}}, {{4, 5, 6}}, {{4, 6, 7}}}));
    for (const Triangle& t : s.triangles) {
        const Double3& a = s.positions[t.vertex[0]];
        const Double3& b = s.positions[t.vertex[1]];
        const Double3& c = s.positions[t.vertex[2]];
        EXPECT_GT((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0);
    }
    EXPECT_EQ(s.face, (std::vector<std::uint32_t>{0, 0, 0, 0}));
}

TEST(FlattenScene, MirroringIsDecidedExactlyHoweverSmallTheScale) {
    Matrix tiny = kIdentity;
    tiny[0] = 1e-30, tiny[5] = 1e-30, tiny[10] = -1e-30;
    const auto result = flatten(Bytes({kTriangle}, {{"a", kNoParent, tiny, {}},
                                                    {"b", 0, tiny, {}},
                                                    {"c", 1, tiny, {}},
                                                    {"d", 2, tiny, {}},
                                                    {"e", 3, tiny, {0}}})
                                    .whole());
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result.value().instances[0].flags, format::instance_mirrored);
}

TEST(FlattenScene, AnIndexIsOutOfRangeWhenItPassesItsOwnMesh) {
    const MeshPart bad = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}, 0};
    const auto result =
        flatten(Bytes({bad, kTriangle}, {{"a", kNoParent, kIdentity, {0, 1}}}).whole());
    ASSERT_TRUE(result.ok());
    ASSERT_EQ(result.value().bad_number_count, 1u);
    EXPECT_EQ(result.value().bad_numbers[0].triangle, 1u);
    EXPECT_EQ(result.value().bad_numbers[0].found, 3);
    EXPECT_EQ(result.value().bad_numbers[0].limit, 3);
}

TEST(FlattenScene, InfiniteNumbersAreDataInPositionsAndTransforms) {
    MeshPart mesh = kTriangle;
    mesh.vertices[1][0] = std::numeric_limits<float>::infinity();
    Matrix broken = kIdentity;
    broken[7] = std::numeric_limits<float>::quiet_NaN();
    const auto result =
        flatten(Bytes({mesh, kTriangle}, {{"a", kNoParent, kIdentity, {0}}, {"b", 0, broken, {1}}})
                    .whole());
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result.value().bad_number_count, 4u);
}

TEST(FlattenScene, PointsAndLinesLeaveNothing) {
    const MeshPart points = {{{0, 0, 0}}, {{0}, {0}}, 0};
    const auto result = flatten(Bytes({points}, {{"a", kNoParent, kIdentity, {0}}}).whole());
    ASSERT_TRUE(result.ok());
    EXPECT_TRUE(result.value().triangles.empty());
    EXPECT_TRUE(result.value().instances.empty());
    EXPECT_TRUE(flatten(Bytes({}, {}).whole()).ok());
}

TEST(FlattenScene, MaterialsAreRunsAndEqualNeighboursOne) {
    MeshPart second = kTriangle;
    second.material = 1;
    const auto result = flatten(
        Bytes({kTriangle, second}, {{"a", kNoParent, kIdentity, {0, 0, 1}}}, {"red", "blue"})
            .whole());
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result.value().materials.names, (std::vector<std::string>{"red", "blue"}));
    ASSERT_EQ(result.value().materials.runs.size(), 2u);
    EXPECT_EQ(result.value().materials.runs[0].triangle_count, 2u);
}

TEST(FlattenScene, ManyInstancesOfOneMeshStayWithinTheMemory) {
    const MeshPart mesh = {std::vector<std::array<double, 3>>(1000), {{0, 1, 2}}, 0};
    const std::vector<NodePart> nodes = {
        {"a", kNoParent, kIdentity, std::vector<std::uint32_t>(1000)}};
    ImportOptions options;
    options.memory_bytes = 1 << 20;
    const auto result = flatten(Bytes({mesh}, nodes).whole(), options);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::over_budget);
}

Bytes small_scene() {
    return Bytes({kTriangle, kTriangle},
                 {{"root", kNoParent, moved(1, 2, 3), {0}}, {"b", 0, kIdentity, {1, 0}}}, {"red"});
}

TEST(FlattenScene, EveryTruncationIsRefused) {
    const std::vector<std::byte> whole = small_scene().whole();
    ASSERT_TRUE(flatten(whole).ok());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<long>(size));
        EXPECT_FALSE(flatten(part).ok()) << size;
        EXPECT_FALSE(read_scene_header(part)) << size;
    }
}

// The names need one byte more than there is text: of the last material, or of the last node.
TEST(FlattenScene, ANameBeyondTheTextIsRefused) {
    Bytes without_materials({kTriangle},
                            {{"root", kNoParent, kIdentity, {0}}, {"b", 0, kIdentity, {0}}}, {});
    for (Bytes bytes : {small_scene(), without_materials}) {
        ASSERT_TRUE(flatten(bytes.whole()).ok());
        bytes.arrays.pop_back();
        --bytes.header.text_bytes;
        EXPECT_FALSE(flatten(bytes.whole()).ok());
    }
}

TEST(FlattenScene, EveryFlippedBitIsRefusedOrHarmless) {
    const std::vector<std::byte> whole = small_scene().whole();
    int soups = 0;
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::vector<std::byte> flipped = whole;
        flipped[bit / 8] ^= std::byte{1} << bit % 8;
        const auto result = flatten(flipped);
        if (!result.ok()) continue;
        ++soups;
        for (const Triangle& t : result.value().triangles) {
            for (const std::uint32_t v : t.vertex) ASSERT_LT(v, result.value().positions.size());
        }
    }
    EXPECT_GT(soups, 100);
}

}  // namespace
}  // namespace cdprep::import
