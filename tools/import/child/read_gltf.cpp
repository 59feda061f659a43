// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gltf_accessors.h"
#include "input_files.h"
#include "json_value.h"

namespace cdprep::import {
namespace {

enum Mode : std::uint64_t { triangles = 4, strip = 5, fan = 6 };

Matrix multiply(const Matrix& a, const Matrix& b) {
    Matrix result{};
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            for (std::size_t k = 0; k < 4; ++k) {
                result[4 * row + column] += a[4 * row + k] * b[4 * k + column];
            }
        }
    }
    return result;
}

Matrix rotation(double x, double y, double z, double w) {
    return {1 - 2 * (y * y + z * z),
            2 * (x * y - z * w),
            2 * (x * z + y * w),
            0,
            2 * (x * y + z * w),
            1 - 2 * (x * x + z * z),
            2 * (y * z - x * w),
            0,
            2 * (x * z - y * w),
            2 * (y * z + x * w),
            1 - 2 * (x * x + y * y),
            0,
            0,
            0,
            0,
            1};
}

Matrix local_transform(JsonValue node) {
    Matrix result = kIdentity;
    if (const JsonValue matrix = node["matrix"]; matrix.exists()) {
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[4 * (i % 4) + i / 4] = matrix[i].number(kIdentity[i]);  // column by column
        }
        return result;
    }
    const JsonValue shift = node["translation"];
    const JsonValue turn = node["rotation"];
    const JsonValue scale = node["scale"];
    if (turn.exists()) {
        result =
            rotation(turn[0].number(0), turn[1].number(0), turn[2].number(0), turn[3].number(1));
    }
    if (scale.exists()) {
        Matrix sizes = kIdentity;
        for (std::size_t i = 0; i < 3; ++i) sizes[5 * i] = scale[i].number(1);
        result = multiply(result, sizes);
    }
    for (std::size_t i = 0; i < 3; ++i) result[4 * i + 3] = shift[i].number(0);
    return result;
}

/// Returns the matrix of an array of glTF, which has one column after the other.
Matrix from_columns(const std::array<double, 16>& numbers) {
    Matrix result{};
    for (std::size_t i = 0; i < result.size(); ++i) result[4 * (i % 4) + i / 4] = numbers[i];
    return result;
}

std::array<double, 3> transformed(const Matrix& m, const std::array<double, 3>& p) {
    std::array<double, 3> result{};
    for (std::size_t row = 0; row < 3; ++row) {
        const double* const r = m.data() + 4 * row;
        result[row] = ((r[0] * p[0] + r[1] * p[1]) + r[2] * p[2]) + r[3];
    }
    return result;
}

bool mirrors(const Matrix& m) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
               m[2] * (m[4] * m[9] - m[5] * m[8]) <
           0;
}

/// One document with its buffers. We use no library: tinygltf does not check accessors against
/// their buffers, and cgltf reports neither the place nor the numbers of an error.
class GltfReader {
public:
    GltfReader(const std::filesystem::path& path, JsonValue root, std::string_view binary,
               InputFiles& files)
        : root_(root), accessors_(path, root, binary, files) {}

    [[nodiscard]] bool is_version_2() const {
        return root_["asset"]["version"].text().starts_with("2.");
    }

    Scene read() {
        check_extensions();
        accessors_.read_buffers();
        for (std::size_t i = 0; i < root_["materials"].items().size(); ++i) {
            scene_.materials.push_back(name_of("materials", i, "material_"));
        }
        for (const JsonValue mesh : root_["meshes"].items()) {
            first_primitive_.push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
            for (const JsonValue primitive : mesh["primitives"].items()) {
                scene_.meshes.push_back(read_primitive(primitive));
            }
        }
        first_primitive_.push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
        read_nodes();
        scene_.metres_per_unit = 1;  // fixed by glTF
        scene_.up_axis = format::UpAxis::y;
        return std::move(scene_);
    }

private:
    /// Refuses unsupported extensions that change the geometry, such as packed meshes and
    /// instances. Extensions for appearance, lights, physics and the like are harmless.
    void check_extensions() const {
        for (const JsonValue name : root_["extensionsRequired"].items()) {
            const std::string& text = name.text();
            const bool is_harmless =
                text == "KHR_mesh_quantization" || text == "KHR_lights_punctual" ||
                text == "KHR_physics_rigid_bodies" || text == "KHR_implicit_shapes" ||
                text.starts_with("KHR_materials") || text.starts_with("KHR_texture") ||
                text.starts_with("EXT_texture");
            if (!is_harmless) fail("it needs the extension " + text + ", which is not supported");
        }
        for (const JsonValue node : root_["nodes"].items()) {
            const std::string_view instancing = "EXT_mesh_gpu_instancing";
            if (node["extensions"][instancing].exists()) {
                fail("it has instances by " + std::string(instancing) +
                     ", which are not supported");
            }
        }
    }

    [[nodiscard]] std::string name_of(std::string_view list, std::size_t i,
                                      const char* otherwise) const {
        const std::string& name = root_[list][i]["name"].text();
        return name.empty() ? otherwise + std::to_string(i) : name;
    }

    [[nodiscard]] Scene::Mesh read_primitive(JsonValue primitive) const {
        Scene::Mesh mesh;
        const std::uint64_t mode = primitive["mode"].count("mode", triangles);
        const JsonValue position = primitive["attributes"]["POSITION"];
        if (mode < triangles || mode > fan || !position.exists()) return mesh;
        if (primitive["material"].exists()) {
            mesh.material = static_cast<std::uint32_t>(primitive["material"].count("material", 0));
        }
        mesh.vertices = accessors_.read<3>(position.count("POSITION", 0));
        add_triangles(mode, indices_of(primitive, mesh.vertices.size()), mesh);
        return mesh;
    }

    /// Returns the indices of a primitive. Without any, its vertices are used in order.
    [[nodiscard]] std::vector<std::uint32_t> indices_of(JsonValue primitive,
                                                        std::uint64_t vertices) const {
        const JsonValue accessor = primitive["indices"];
        if (accessor.exists()) return accessors_.read_indices(accessor.count("indices", 0));
        std::vector<std::uint32_t> indices(vertices);
        std::iota(indices.begin(), indices.end(), 0U);
        return indices;
    }

    static void add_triangles(std::uint64_t mode, const std::vector<std::uint32_t>& list,
                              Scene::Mesh& mesh) {
        const std::size_t step = mode == triangles ? 3 : 1;
        for (std::size_t i = 0; i + 3 <= list.size(); i += step) {
            const std::size_t odd = mode == strip ? i % 2 : 0;
            mesh.corners.push_back(list[mode == fan ? 0 : i]);
            mesh.corners.push_back(list[i + 1 + odd]);
            mesh.corners.push_back(list[i + 2 - odd]);
            mesh.sizes.push_back(3);
        }
    }

    struct Pending {
        std::uint64_t node;
        std::uint32_t parent;
        std::uint32_t depth;
    };

    /// Reads the nodes depth first from the scene's roots. A path longer than the list of nodes
    /// visits one of them twice, so the scene has a cycle.
    void read_nodes() {
        constexpr std::size_t kMaxUses = 1'000'000;  // nodes with several parents multiply
        std::vector<Pending> pending = roots();
        const std::size_t count = root_["nodes"].items().size();
        while (!pending.empty()) {
            const Pending top = pending.back();
            pending.pop_back();
            const JsonValue node = root_["nodes"][top.node];
            const std::string name = "node " + std::to_string(top.node);
            if (!node.exists()) fail(name + " does not exist");
            if (top.depth >= count) fail(name + " is its own descendant");
            if (scene_.nodes.size() >= kMaxUses) {
                fail("its nodes are used more than " + std::to_string(kMaxUses) + " times");
            }
            const auto number = static_cast<std::uint32_t>(scene_.nodes.size());
            scene_.nodes.push_back({name_of("nodes", top.node, "node_"), top.parent,
                                    local_transform(node), meshes_of(node), node["skin"].exists()});
            const std::vector<JsonValue> children = node["children"].items();
            for (auto child = children.rbegin(); child != children.rend(); ++child) {
                pending.push_back({child->count("child", 0), number, top.depth + 1});
            }
        }
    }

    [[nodiscard]] std::vector<Pending> roots() const {
        std::vector<Pending> result;
        const std::vector<JsonValue> scenes = root_["scenes"].items();
        if (!scenes.empty()) {
            const JsonValue scene = root_["scenes"][root_["scene"].count("scene", 0)];
            if (!scene.exists()) fail("its scene does not exist");
            for (const JsonValue node : scene["nodes"].items()) {
                result.push_back({node.count("node", 0), kNoParent, 0});
            }
        } else {
            result = nodes_without_parent();
        }
        std::reverse(result.begin(), result.end());
        return result;
    }

    [[nodiscard]] std::vector<Pending> nodes_without_parent() const {
        const std::vector<JsonValue> nodes = root_["nodes"].items();
        std::vector<bool> is_child(nodes.size(), false);
        for (const JsonValue node : nodes) {
            for (const JsonValue child : node["children"].items()) {
                const std::uint64_t number = child.count("child", 0);
                if (number < nodes.size()) is_child[number] = true;
            }
        }
        std::vector<Pending> result;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (!is_child[i]) result.push_back({i, kNoParent, 0});
        }
        return result;
    }

    // --- Poses -----------------------------------------------------------------------

    /// The pose in which a node shows its mesh.
    struct PoseKey {
        std::uint64_t mesh = 0;
        std::vector<double> weights;  ///< of the morph targets; empty: all are 0
        std::optional<std::uint64_t> skin;

        auto operator<=>(const PoseKey&) const = default;
    };

    /// Returns the primitives of a node's mesh, in the pose that the file gives them.
    [[nodiscard]] std::vector<std::uint32_t> meshes_of(JsonValue node) {
        if (!node["mesh"].exists()) return {};
        PoseKey key;
        key.mesh = node["mesh"].count("mesh", 0);
        if (key.mesh + 1 >= first_primitive_.size()) {
            fail("mesh " + std::to_string(key.mesh) + " does not exist");
        }
        key.weights = weights_of(node, root_["meshes"][key.mesh]);
        if (node["skin"].exists()) key.skin = node["skin"].count("skin", 0);
        const auto [known, is_new] = posed_.try_emplace(key);
        if (is_new) known->second = pose(key);
        return known->second;
    }

    [[nodiscard]] static std::vector<double> weights_of(JsonValue node, JsonValue mesh) {
        const JsonValue list = node["weights"].exists() ? node["weights"] : mesh["weights"];
        std::vector<double> weights;
        for (const JsonValue weight : list.items()) weights.push_back(weight.number(0));
        while (!weights.empty() && weights.back() == 0) weights.pop_back();
        return weights;
    }

    [[nodiscard]] std::vector<std::uint32_t> pose(const PoseKey& key) {
        std::vector<std::uint32_t> numbers(first_primitive_[key.mesh + 1] -
                                           first_primitive_[key.mesh]);
        std::iota(numbers.begin(), numbers.end(), first_primitive_[key.mesh]);
        if (key.weights.empty() && !key.skin) return numbers;
        const std::vector<JsonValue> primitives = root_["meshes"][key.mesh]["primitives"].items();
        const std::vector<Matrix> joints = key.skin ? joints_of(*key.skin) : std::vector<Matrix>();
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            Scene::Mesh mesh = scene_.meshes[numbers[i]];
            if (mesh.corners.empty()) continue;
            const std::string name =
                "primitive " + std::to_string(i) + " of mesh " + std::to_string(key.mesh);
            morph(name, primitives[i]["targets"], key.weights, mesh);
            if (key.skin) bend(name, primitives[i]["attributes"], joints, mesh);
            mesh.is_single = false;
            numbers[i] = static_cast<std::uint32_t>(scene_.meshes.size());
            scene_.meshes.push_back(std::move(mesh));
        }
        return numbers;
    }

    /// Adds the morph targets, each times its weight.
    void morph(const std::string& name, JsonValue targets, const std::vector<double>& weights,
               Scene::Mesh& mesh) const {
        const std::size_t count = targets.items().size();
        if (weights.size() > count) {
            fail(name + " has " + std::to_string(count) + " morph targets, but number " +
                 std::to_string(weights.size()) + " has a weight");
        }
        for (std::size_t target = 0; target < weights.size(); ++target) {
            const JsonValue position = targets[target]["POSITION"];
            if (weights[target] == 0 || !position.exists()) continue;
            const auto offsets = read_attribute<3>(name, "morph target", position,
                                                   mesh.vertices.size(), NoData::zeros);
            for (std::size_t i = 0; i < offsets.size(); ++i) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    mesh.vertices[i][axis] += weights[target] * offsets[i][axis];
                }
            }
        }
    }

    /// Reads an attribute of a primitive, which must have an element for each vertex.
    template <std::size_t Width>
    [[nodiscard]] std::vector<std::array<double, Width>> read_attribute(
        const std::string& name, const std::string& attribute, JsonValue accessor,
        std::size_t vertices, NoData no_data = NoData::refused) const {
        if (!accessor.exists()) fail(name + " has a skin, but no " + attribute);
        const std::uint64_t number = accessor.count(attribute, 0);
        // Checked first: elements without data would take memory for any count.
        if (const std::uint64_t count = accessors_.count_of(number); count != vertices) {
            fail(name + " has " + std::to_string(vertices) + " vertices, but its " + attribute +
                 " has " + std::to_string(count));
        }
        return accessors_.read<Width>(number, no_data);
    }

    // --- Skins -----------------------------------------------------------------------

    /// Computes the transforms of all nodes. Of a node with several parents, the first counts.
    void place_all_nodes() {
        const std::size_t count = root_["nodes"].items().size();
        model_from_node_.resize(count);
        std::vector<Pending> pending = nodes_without_parent();
        while (!pending.empty()) {
            const Pending top = pending.back();
            pending.pop_back();
            if (top.node >= count || model_from_node_[top.node]) continue;
            const JsonValue node = root_["nodes"][top.node];
            const Matrix own = local_transform(node);
            model_from_node_[top.node] =
                top.parent == kNoParent ? own : multiply(*model_from_node_[top.parent], own);
            for (const JsonValue child : node["children"].items()) {
                pending.push_back(
                    {child.count("child", 0), static_cast<std::uint32_t>(top.node), 0});
            }
        }
    }

    /// Returns for each joint of a skin where it moves the vertices that follow it alone.
    [[nodiscard]] std::vector<Matrix> joints_of(std::uint64_t number) {
        const JsonValue skin = root_["skins"][number];
        const std::string name = "skin " + std::to_string(number);
        if (!skin.exists()) fail(name + " does not exist");
        if (model_from_node_.empty()) place_all_nodes();
        const std::vector<JsonValue> joints = skin["joints"].items();
        std::vector<std::array<double, 16>> binds;
        if (const JsonValue inverse = skin["inverseBindMatrices"]; inverse.exists()) {
            binds = accessors_.read<16>(inverse.count("inverseBindMatrices", 0));
            if (binds.size() < joints.size()) {
                fail(name + " has " + std::to_string(joints.size()) + " joints, but " +
                     std::to_string(binds.size()) + " inverse bind matrices");
            }
        }
        std::vector<Matrix> result;
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const std::uint64_t node = joints[i].count("joint", 0);
            if (node >= model_from_node_.size() || !model_from_node_[node]) {
                fail(name + " has the joint " + std::to_string(node) +
                     ", which is no node below a root");
            }
            result.push_back(*model_from_node_[node]);
            if (!binds.empty()) result.back() = multiply(result.back(), from_columns(binds[i]));
        }
        return result;
    }

    /// The sums of the places that joints give the vertices of a primitive, each times its weight.
    struct Bent {
        explicit Bent(std::size_t vertices)
            : moved(vertices), sums(vertices), has_weights(vertices), first_joint(vertices) {}

        std::vector<std::array<double, 3>> moved;
        std::vector<double> sums;  ///< of the weights
        std::vector<bool> has_weights;
        std::vector<double> first_joint;  ///< the first number of JOINTS_0
        bool all_mirror = true;

        void follow(std::size_t vertex, const std::array<double, 3>& from, const Matrix& joint,
                    double weight) {
            const auto place = transformed(joint, from);
            for (std::size_t i = 0; i < 3; ++i) moved[vertex][i] += weight * place[i];
            sums[vertex] += weight;
            has_weights[vertex] = true;
            all_mirror = all_mirror && mirrors(joint);
        }
    };

    /// Moves each vertex to the weighted mean of the places that its joints give it. We divide by
    /// the sum of the weights, which is 1 only up to rounding. Faces are reversed if all joints
    /// mirror.
    void bend(const std::string& name, JsonValue attributes, const std::vector<Matrix>& joints,
              Scene::Mesh& mesh) {
        Bent bent(mesh.vertices.size());
        for (std::size_t set = 0; set == 0 || has_joints(attributes, set); ++set) {
            follow_joints(name, attributes, set, joints, mesh, bent);
        }
        follow_first_joints(name, joints, mesh, bent);
        for (std::size_t i = 0; i < bent.moved.size(); ++i) {
            if (!(bent.sums[i] > 0)) {
                fail(name + " has joint weights at vertex " + std::to_string(i) +
                     " whose sum is not above 0; expected 1");
            }
            for (double& x : bent.moved[i]) x /= bent.sums[i];
        }
        mesh.vertices = std::move(bent.moved);
        for (std::size_t i = 0; bent.all_mirror && i < mesh.corners.size(); i += 3) {
            std::swap(mesh.corners[i + 1], mesh.corners[i + 2]);
        }
    }

    /// Adds the places by one set of four joints per vertex.
    void follow_joints(const std::string& name, JsonValue attributes, std::size_t set,
                       const std::vector<Matrix>& joints, const Scene::Mesh& mesh,
                       Bent& bent) const {
        const std::string numbers = "JOINTS_" + std::to_string(set);
        const std::string weights = "WEIGHTS_" + std::to_string(set);
        const std::size_t count = mesh.vertices.size();
        const auto number = read_attribute<4>(name, numbers, attributes[numbers], count);
        const auto weight = read_attribute<4>(name, weights, attributes[weights], count);
        for (std::size_t i = 0; i < 4 * count; ++i) {
            const std::size_t vertex = i / 4;
            const double w = weight[vertex][i % 4];
            if (set == 0 && i % 4 == 0) bent.first_joint[vertex] = number[vertex][0];
            if (w == 0) continue;
            bent.follow(vertex, mesh.vertices[vertex],
                        find_joint(name, number[vertex][i % 4], joints), w);
        }
    }

    /// Lets vertices whose weights are all 0 follow their first joint. They have no defined
    /// place, and viewers such as three.js show them there.
    void follow_first_joints(const std::string& name, const std::vector<Matrix>& joints,
                             const Scene::Mesh& mesh, Bent& bent) {
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            if (bent.has_weights[i]) continue;
            bent.follow(i, mesh.vertices[i], find_joint(name, bent.first_joint[i], joints), 1);
            ++scene_.weightless_vertices;
        }
    }

    [[nodiscard]] static bool has_joints(JsonValue attributes, std::size_t set) {
        return attributes["JOINTS_" + std::to_string(set)].exists() ||
               attributes["WEIGHTS_" + std::to_string(set)].exists();
    }

    [[nodiscard]] static const Matrix& find_joint(const std::string& name, double number,
                                                  const std::vector<Matrix>& joints) {
        const bool is_whole = std::fabs(number) <= 65535 && number == std::floor(number);
        if (is_whole && number >= 0 && number < static_cast<double>(joints.size())) {
            return joints[static_cast<std::size_t>(number)];
        }
        fail(name + " uses joint " +
             (is_whole ? std::to_string(static_cast<int>(number)) : std::to_string(number)) +
             ", but its skin has " + std::to_string(joints.size()) + " joints");
    }

    JsonValue root_;
    GltfAccessors accessors_;
    std::vector<std::uint32_t> first_primitive_;
    std::map<PoseKey, std::vector<std::uint32_t>> posed_;
    std::vector<std::optional<Matrix>> model_from_node_;  ///< by node, once a skin needs them
    Scene scene_;
};

/// The JSON and the binary part of a file.
struct Parts {
    std::string_view json;
    std::string_view binary;
};

/// Splits a GLB: a header of 12 bytes, then chunks of length, type and content.
std::optional<Parts> split_glb(std::string_view bytes) {
    constexpr std::size_t kHeader = 12;
    constexpr std::size_t kChunkHeader = 8;
    if (bytes.size() < kHeader + kChunkHeader) fail("the GLB header is cut off");
    if (load<std::uint32_t>(bytes.data() + 4) != 2) return std::nullopt;
    const std::uint64_t length = load<std::uint32_t>(bytes.data() + 8);
    if (length > bytes.size()) {
        fail("the GLB header declares " + std::to_string(length) + " bytes, but the file has " +
             std::to_string(bytes.size()));
    }
    Parts parts;
    for (std::size_t at = kHeader; bytes.size() - at >= kChunkHeader;) {
        const std::uint64_t size = load<std::uint32_t>(bytes.data() + at);
        const std::string_view type = bytes.substr(at + 4, 4);
        at += kChunkHeader;
        if (size > bytes.size() - at) fail("a chunk of the GLB file is cut off");
        const std::string_view chunk = bytes.substr(at, size);
        if (type == "JSON" && parts.json.empty()) parts.json = chunk;
        if (type == std::string_view("BIN\0", 4) && parts.binary.empty()) parts.binary = chunk;
        at += size;
    }
    return parts;
}

}  // namespace

std::optional<Scene> read_gltf(const std::filesystem::path& path, InputFiles& files) {
    constexpr std::string_view kMagic = "glTF";
    std::ifstream stream(path, std::ios::binary);
    std::string start(64, '\0');
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    const std::size_t first = start.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    const bool is_glb = start.starts_with(kMagic);
    if (!is_glb && (first == std::string::npos || start[first] != '{')) return std::nullopt;

    const std::string bytes = read_bytes(path, files);
    std::optional<Parts> parts = is_glb ? split_glb(bytes) : Parts{bytes, {}};
    if (!parts) return std::nullopt;
    const nlohmann::json document = parse_json(parts->json);
    GltfReader reader(path, JsonValue(document), parts->binary, files);
    if (!reader.is_version_2()) return std::nullopt;
    return reader.read();
}

}  // namespace cdprep::import
