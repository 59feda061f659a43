// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "input_files.h"
#include "json_value.h"

namespace cdprep::import {
namespace {

enum Mode : std::uint64_t { triangles = 4, strip = 5, fan = 6 };
enum Component : std::uint64_t {
    i8 = 5120,
    u8 = 5121,
    i16 = 5122,
    u16 = 5123,
    u32 = 5125,
    f32 = 5126
};

std::string read_bytes(const std::filesystem::path& path, InputFiles& files) {
    const std::uint64_t size = std::filesystem::file_size(path);
    files.note_opened(path, size);
    std::string bytes(size, '\0');
    std::ifstream stream(path, std::ios::binary);
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream) fail(path.filename().string() + " cannot be read completely");
    return bytes;
}

template <class T>
T load(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

std::uint64_t size_of(std::uint64_t component) {
    switch (component) {
        case i8:
        case u8:
            return 1;
        case i16:
        case u16:
            return 2;
        case u32:
        case f32:
            return 4;
        default:
            fail("component type " + std::to_string(component) + " is not a type of glTF");
    }
}

/// Returns the value of one component. Integers are divided by their limit if `normalized`.
float load_component(std::uint64_t component, const char* at, bool normalized) {
    const auto scaled = [&](auto value, float limit) {
        const auto x = static_cast<float>(value);
        return normalized ? std::max(x / limit, -1.0f) : x;
    };
    switch (component) {
        case i8:
            return scaled(load<std::int8_t>(at), 127);
        case u8:
            return scaled(load<std::uint8_t>(at), 255);
        case i16:
            return scaled(load<std::int16_t>(at), 32767);
        case u16:
            return scaled(load<std::uint16_t>(at), 65535);
        case f32:
            return load<float>(at);
        default:
            fail("a position has component type " + std::to_string(component) +
                 ", which is not supported");
    }
}

std::uint32_t load_index(std::uint64_t component, const char* at) {
    switch (component) {
        case u8:
            return load<std::uint8_t>(at);
        case u16:
            return load<std::uint16_t>(at);
        case u32:
            return load<std::uint32_t>(at);
        default:
            fail("an index has component type " + std::to_string(component) +
                 ", which is not supported");
    }
}

/// assimp has such a function, but does not export it.
std::string decode_base64(std::string_view text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::size_t digit = kDigits.find(c);
        if (digit == std::string_view::npos) break;  // padding
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 0xff);
    }
    return bytes;
}

std::string decode_percent(std::string_view uri) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const bool escaped =
            uri[i] == '%' && i + 2 < uri.size() &&
            std::sscanf(std::string(uri.substr(i + 1, 2)).c_str(), "%2x", &code) == 1;
        name += escaped ? static_cast<char>(code) : uri[i];
        if (escaped) i += 2;
    }
    return name;
}

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

/// One document with its buffers. We use no library: tinygltf does not check accessors against
/// their buffers, and cgltf reports neither the place nor the numbers of an error.
class GltfReader {
public:
    GltfReader(const std::filesystem::path& path, JsonValue root, std::string_view binary,
               InputFiles& files)
        : path_(path), root_(root), binary_(binary), files_(files) {}

    [[nodiscard]] bool is_version_2() const {
        return root_["asset"]["version"].text().starts_with("2.");
    }

    Scene read() {
        check_extensions();
        read_buffers();
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

    void read_buffers() {
        for (const JsonValue buffer : root_["buffers"].items()) {
            const std::string& uri = buffer["uri"].text();
            if (uri.empty()) {
                owned_.emplace_back();
                buffers_.push_back(buffers_.empty() ? binary_ : std::string_view());
                continue;
            }
            if (uri.starts_with("data:")) {
                const std::size_t comma = std::min(uri.find(','), uri.size() - 1);
                owned_.push_back(decode_base64(std::string_view(uri).substr(comma + 1)));
            } else {
                owned_.push_back(read_buffer_file(decode_percent(uri)));
            }
            buffers_.push_back(owned_.back());
        }
        // The bytes of a string may have moved with it.
        for (std::size_t i = 0; i < owned_.size(); ++i) {
            if (!owned_[i].empty()) buffers_[i] = owned_[i];
        }
    }

    [[nodiscard]] std::string read_buffer_file(const std::string& name) const {
        const auto file = files_.find(path_.parent_path() / name);
        if (!file) {
            fail("buffer " + std::to_string(buffers_.size()) + ", " + name +
                 ", cannot be opened or is not in the file's folder");
        }
        return read_bytes(*file, files_);
    }

    struct Accessor {
        const char* at = nullptr;
        std::uint64_t count = 0;
        std::uint64_t stride = 0;
        std::uint64_t component = 0;
    };

    /// Finds `count` elements of `width` components at `place`, an accessor or a part of a sparse
    /// one. Proves that all of them lie in their buffer.
    [[nodiscard]] Accessor find(const std::string& name, JsonValue place, std::uint64_t component,
                                std::uint64_t count, std::uint64_t width) const {
        Accessor result;
        result.component = component;
        result.count = count;
        const std::uint64_t element = width * size_of(result.component);
        if (!place["bufferView"].exists()) fail(name + " has no data");
        const JsonValue view = root_["bufferViews"][place["bufferView"].count("bufferView", 0)];
        const std::uint64_t buffer = view["buffer"].count("buffer", buffers_.size());
        if (buffer >= buffers_.size()) fail(name + " is in a buffer that does not exist");
        result.stride = view["byteStride"].count("byteStride", element);
        if (result.stride < element) fail(name + " has elements that overlap");
        const std::uint64_t offset =
            view["byteOffset"].count("byteOffset", 0) + place["byteOffset"].count("byteOffset", 0);
        const std::uint64_t size = buffers_[buffer].size();
        const bool fits =
            offset <= size && (result.count == 0 || size - offset >= element) &&
            (result.count == 0 || result.count - 1 <= (size - offset - element) / result.stride);
        if (!fits) {
            fail(name + " declares " + std::to_string(result.count) + " elements from byte " +
                 std::to_string(offset) + " of buffer " + std::to_string(buffer) + ", which has " +
                 std::to_string(size) + " bytes");
        }
        result.at = buffers_[buffer].data() + offset;
        return result;
    }

    [[nodiscard]] Scene::Mesh read_primitive(JsonValue primitive) const {
        Scene::Mesh mesh;
        const std::uint64_t mode = primitive["mode"].count("mode", triangles);
        const JsonValue position = primitive["attributes"]["POSITION"];
        if (mode < triangles || mode > fan || !position.exists()) return mesh;
        if (primitive["material"].exists()) {
            mesh.material = static_cast<std::uint32_t>(primitive["material"].count("material", 0));
        }
        mesh.vertices = read_points(position.count("POSITION", 0));
        add_triangles(mode, read_indices(primitive, mesh.vertices.size()), mesh);
        return mesh;
    }

    /// Returns the elements of an accessor of positions. They are zeros if it is sparse and has no
    /// buffer view.
    [[nodiscard]] std::vector<std::array<double, 3>> read_points(std::uint64_t number) const {
        const JsonValue accessor = root_["accessors"][number];
        const std::string name = "accessor " + std::to_string(number);
        if (!accessor.exists()) fail(name + " does not exist");
        if (accessor["type"].text() != "VEC3") fail(name + " is not a VEC3");
        const std::uint64_t component = accessor["componentType"].count("componentType", 0);
        const std::uint64_t count = accessor["count"].count("count", 0);
        const JsonValue sparse = accessor["sparse"];
        std::vector<std::array<double, 3>> points;
        if (accessor["bufferView"].exists() || !sparse.exists()) {
            const Accessor all = find(name, accessor, component, count, 3);
            points.reserve(count);
            for (std::uint64_t i = 0; i < count; ++i) points.push_back(point(accessor, all, i));
        } else {
            points.resize(count);
        }
        if (sparse.exists()) replace_some(name, accessor, points);
        return points;
    }

    void replace_some(const std::string& name, JsonValue accessor,
                      std::vector<std::array<double, 3>>& points) const {
        const JsonValue sparse = accessor["sparse"];
        const std::uint64_t count = sparse["count"].count("count", 0);
        const Accessor numbers = find(
            name, sparse["indices"], sparse["indices"]["componentType"].count("type", 0), count, 1);
        const Accessor values =
            find(name, sparse["values"], accessor["componentType"].count("type", 0), count, 3);
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::uint32_t at = load_index(numbers.component, numbers.at + i * numbers.stride);
            if (at >= points.size()) {
                fail(name + " replaces element " + std::to_string(at) + " of " +
                     std::to_string(points.size()));
            }
            points[at] = point(accessor, values, i);
        }
    }

    static std::array<double, 3> point(JsonValue accessor, const Accessor& values,
                                       std::uint64_t i) {
        const bool normalized = accessor["normalized"].is_true();
        const char* const at = values.at + i * values.stride;
        const std::uint64_t bytes = size_of(values.component);
        std::array<double, 3> p{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            p[axis] = load_component(values.component, at + axis * bytes, normalized);
        }
        return p;
    }

    [[nodiscard]] std::vector<std::uint32_t> read_indices(JsonValue primitive,
                                                          std::uint64_t vertices) const {
        std::vector<std::uint32_t> indices;
        if (!primitive["indices"].exists()) {
            indices.resize(vertices);
            for (std::size_t i = 0; i < indices.size(); ++i) {
                indices[i] = static_cast<std::uint32_t>(i);
            }
            return indices;
        }
        const std::uint64_t number = primitive["indices"].count("indices", 0);
        const JsonValue accessor = root_["accessors"][number];
        const std::string name = "accessor " + std::to_string(number);
        if (!accessor.exists()) fail(name + " does not exist");
        if (accessor["type"].text() != "SCALAR") fail(name + " is not a SCALAR");
        if (accessor["sparse"].exists())
            fail(name + " of indices is sparse, which is not supported");
        const Accessor list =
            find(name, accessor, accessor["componentType"].count("componentType", 0),
                 accessor["count"].count("count", 0), 1);
        indices.reserve(list.count);
        for (std::uint64_t i = 0; i < list.count; ++i) {
            indices.push_back(load_index(list.component, list.at + i * list.stride));
        }
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
                                    local_transform(node), meshes_of(node)});
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

    [[nodiscard]] std::vector<std::uint32_t> meshes_of(JsonValue node) const {
        std::vector<std::uint32_t> meshes;
        if (!node["mesh"].exists()) return meshes;
        const std::uint64_t mesh = node["mesh"].count("mesh", 0);
        if (mesh + 1 >= first_primitive_.size()) {
            fail("mesh " + std::to_string(mesh) + " does not exist");
        }
        for (std::uint32_t i = first_primitive_[mesh]; i < first_primitive_[mesh + 1]; ++i) {
            meshes.push_back(i);
        }
        return meshes;
    }

    const std::filesystem::path& path_;
    JsonValue root_;
    std::string_view binary_;
    InputFiles& files_;
    std::vector<std::string> owned_;
    std::vector<std::string_view> buffers_;
    std::vector<std::uint32_t> first_primitive_;
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
