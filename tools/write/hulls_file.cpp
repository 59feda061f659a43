// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/hulls_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "write/mesh_bytes.h"
#include "write/output_file.h"

namespace cdprep::write {
namespace {

namespace fs = std::filesystem;
using format::Double3;

constexpr const char* kVisual = "visual";  ///< no hull's name

void append_object(std::string& text, const HullArrays& hull, std::uint64_t& first) {
    text += "o " + hull.name + "\n";
    for (const Double3& p : hull.points) {
        text += "v ";
        append_point_text(text, p);
        text += '\n';
    }
    for (const auto& f : hull.facets) append_triangle(text, {f}, "f ", first);
    first += hull.points.size();
}

std::string obj_text(std::span<const HullArrays> hulls) {
    std::string text;
    std::uint64_t first = 1;
    for (const HullArrays& hull : hulls) append_object(text, hull, first);
    return text;
}

/// A value of JSON with its name: "name":value, with a comma before it unless it is the first.
void append_member(std::string& json, const char* name, const std::string& value) {
    if (json.back() != '{') json += ',';
    json += '"';
    json += name;
    json += "\":" + value;
}

std::string text_of(double value) {
    std::string text;
    append_number(text, static_cast<float>(value));
    return text;
}

/// [least, greatest] of each axis as glTF wants them, of the floats that are written.
std::string bound_text(const HullArrays& hull, bool upper) {
    std::string text = "[";
    for (const auto axis : {&Double3::x, &Double3::y, &Double3::z}) {
        float bound = static_cast<float>(hull.points.front().*axis);
        for (const Double3& p : hull.points) {
            const auto value = static_cast<float>(p.*axis);
            bound = upper ? std::max(bound, value) : std::min(bound, value);
        }
        if (text.size() > 1) text += ',';
        text += text_of(static_cast<double>(bound));
    }
    return text + "]";
}

std::string joined(const std::vector<std::string>& parts) {
    std::string text = "[";
    for (const std::string& part : parts) {
        if (text.size() > 1) text += ',';
        text += part;
    }
    return text + "]";
}

/// The arrays of glTF's document.
struct GltfLists {
    std::vector<std::string> nodes, meshes, accessors, views, roots;
};

void add_view(GltfLists& lists, std::size_t offset, std::size_t length, int target) {
    std::string view = "{";
    append_member(view, "buffer", "0");
    append_member(view, "byteOffset", std::to_string(offset));
    append_member(view, "byteLength", std::to_string(length));
    append_member(view, "target", std::to_string(target));
    lists.views.push_back(view + "}");
}

std::string accessor(std::size_t view, int component, std::size_t count, const char* type) {
    std::string text = "{";
    append_member(text, "bufferView", std::to_string(view));
    append_member(text, "componentType", std::to_string(component));
    append_member(text, "count", std::to_string(count));
    append_member(text, "type", std::string("\"") + type + "\"");
    return text;
}

void add_node(GltfLists& lists, std::string& binary, const HullArrays& hull) {
    constexpr int kFloat = 5126;
    constexpr int kUnsignedInt = 5125;
    constexpr int kArrayBuffer = 34962;
    constexpr int kElementArrayBuffer = 34963;
    const std::size_t positions = binary.size();
    for (const Double3& p : hull.points) append_point(binary, p, true);
    const std::size_t indices = binary.size();
    for (const auto& f : hull.facets) {
        for (const std::uint32_t i : f) append_bytes(binary, i);
    }
    add_view(lists, positions, indices - positions, kArrayBuffer);
    std::string places = accessor(lists.views.size() - 1, kFloat, hull.points.size(), "VEC3");
    append_member(places, "min", bound_text(hull, false));
    append_member(places, "max", bound_text(hull, true));
    lists.accessors.push_back(places + "}");
    std::string primitive = "{\"attributes\":{\"POSITION\":";
    primitive += std::to_string(lists.accessors.size() - 1) + "}";
    if (!hull.facets.empty()) {
        add_view(lists, indices, binary.size() - indices, kElementArrayBuffer);
        lists.accessors.push_back(
            accessor(lists.views.size() - 1, kUnsignedInt, 3 * hull.facets.size(), "SCALAR") + "}");
        append_member(primitive, "indices", std::to_string(lists.accessors.size() - 1));
    } else {
        append_member(primitive, "mode", "0");  // points
    }
    std::string mesh = "{";
    append_member(mesh, "name", "\"" + hull.name + "\"");
    append_member(mesh, "primitives", "[" + primitive + "}]");
    std::string node = "{";
    append_member(node, "name", "\"" + hull.name + "\"");
    append_member(node, "mesh", std::to_string(lists.meshes.size()));
    lists.roots.push_back(std::to_string(lists.nodes.size()));
    lists.meshes.push_back(mesh + "}");
    lists.nodes.push_back(node + "}");
}

void append_chunk(std::string& bytes, std::string chunk, std::uint32_t type, char padding) {
    while (chunk.size() % 4 != 0) chunk += padding;
    append_bytes(bytes, static_cast<std::uint32_t>(chunk.size()));
    append_bytes(bytes, type);
    bytes += chunk;
}

std::string glb_bytes(std::span<const HullArrays> hulls) {
    GltfLists lists;
    std::string binary;
    for (const HullArrays& hull : hulls) add_node(lists, binary, hull);
    std::string json = "{";
    append_member(json, "asset", R"({"version":"2.0","generator":"cdprep"})");
    std::string scene = "{}";
    if (!lists.roots.empty()) {
        scene = R"({"nodes":)" + joined(lists.roots) + "}";
        append_member(json, "nodes", joined(lists.nodes));
        append_member(json, "meshes", joined(lists.meshes));
        append_member(json, "accessors", joined(lists.accessors));
        append_member(json, "bufferViews", joined(lists.views));
        append_member(json, "buffers", R"([{"byteLength":)" + std::to_string(binary.size()) + "}]");
    }
    append_member(json, "scene", "0");
    append_member(json, "scenes", "[" + scene + "]");
    json += "}";
    constexpr std::uint32_t kMagic = 0x46546C67;
    constexpr std::uint32_t kJson = 0x4E4F534A;
    constexpr std::uint32_t kBinary = 0x004E4942;
    std::string chunks;
    append_chunk(chunks, json, kJson, ' ');
    if (!binary.empty()) append_chunk(chunks, binary, kBinary, '\0');
    std::string bytes;
    append_bytes(bytes, kMagic);
    append_bytes(bytes, std::uint32_t{2});
    append_bytes(bytes, static_cast<std::uint32_t>(chunks.size() + 12));
    return bytes + chunks;
}

std::string scale_text(double scale) {
    std::string text;
    for (int i = 0; i < 3; ++i) {
        if (i > 0) text += ' ';
        append_number(text, scale);
    }
    return text;
}

/// A name of letters, digits, '_', '-' and '.', which needs no escape in XML, in addresses or
/// in a shell.
std::string plain_name(const fs::path& path) {
    std::string name = path.stem().string();
    for (char& letter : name) {
        const bool is_plain =
            (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
            (letter >= '0' && letter <= '9') || letter == '_' || letter == '-' || letter == '.';
        if (!is_plain) letter = '_';
    }
    return name;
}

/// Where the names of meshes begin: no two files in a folder have the same, but by extension.
std::string mesh_stem(const fs::path& path) {
    std::string name = plain_name(path);
    const std::string stem = path.stem().string();
    if (name == stem) return name;
    std::uint32_t hash = 2166136261U;  // FNV-1a
    for (const char letter : stem) {
        hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619U;
    }
    return name + "_" + std::to_string(hash);
}

std::string mesh_name(const fs::path& path, const std::string& hull) {
    return mesh_stem(path) + "_" + hull + ".obj";
}

/// One number behind a name, as XML's attribute.
std::string attribute(const char* name, double value) {
    std::string text = std::string(" ") + name + "=\"";
    append_number(text, value);
    return text + "\"";
}

std::string point_text(const Double3& p) {
    std::string text;
    append_point_text(text, p);
    return text;
}

/// The six numbers of an inertia as URDF and SDF call them, and their place in BodyMass.
struct InertiaName {
    const char* name;
    std::size_t place;
};
constexpr std::array<InertiaName, 6> kInertiaNames = {
    {{"ixx", 0}, {"ixy", 3}, {"ixz", 5}, {"iyy", 1}, {"iyz", 4}, {"izz", 2}}};

/// What is the same in every element of a file.
struct RobotFile {
    const fs::path& path;
    std::span<const HullArrays> hulls;
    const HullsFileOptions& options;
    std::string scale;
};

std::string urdf_inertial(const BodyMass& body) {
    std::string text = "    <inertial>\n      <origin xyz=\"" + point_text(body.centre) +
                       "\" rpy=\"0 0 0\"/>\n      <mass" + attribute("value", body.mass) +
                       "/>\n      <inertia";
    for (const auto& [name, place] : kInertiaNames) text += attribute(name, body.inertia[place]);
    return text + "/>\n    </inertial>\n";
}

std::string urdf_shape(const RobotFile& file, const char* kind, const std::string& name) {
    return std::string("    <") + kind + " name=\"" + name +
           "\">\n      <origin xyz=\"0 0 0\" rpy=\"0 0 0\"/>\n      <geometry><mesh filename=\"" +
           mesh_name(file.path, name) + "\" scale=\"" + file.scale + "\"/></geometry>\n    </" +
           kind + ">\n";
}

std::string urdf_text(const RobotFile& file) {
    const std::string name = plain_name(file.path);
    std::string text =
        "<?xml version=\"1.0\"?>\n<robot name=\"" + name + "\">\n  <link name=\"" + name + "\">\n";
    if (file.options.mass) text += urdf_inertial(*file.options.mass);
    if (file.options.visual) text += urdf_shape(file, "visual", kVisual);
    for (const HullArrays& hull : file.hulls) text += urdf_shape(file, "collision", hull.name);
    return text + "  </link>\n</robot>\n";
}

std::string sdf_inertial(const BodyMass& body) {
    std::string text = "      <inertial>\n        <pose>" + point_text(body.centre) +
                       " 0 0 0</pose>\n        <mass>";
    append_number(text, body.mass);
    text += "</mass>\n        <inertia>";
    for (const auto& [name, place] : kInertiaNames) {
        text += std::string("<") + name + ">";
        append_number(text, body.inertia[place]);
        text += std::string("</") + name + ">";
    }
    return text + "</inertia>\n      </inertial>\n";
}

std::string sdf_shape(const RobotFile& file, const char* kind, const std::string& name) {
    return std::string("      <") + kind + " name=\"" + name +
           "\">\n        <geometry><mesh><uri>" + mesh_name(file.path, name) + "</uri><scale>" +
           file.scale + "</scale></mesh></geometry>\n      </" + kind + ">\n";
}

std::string sdf_text(const RobotFile& file) {
    const std::string name = plain_name(file.path);
    std::string text = "<?xml version=\"1.0\"?>\n<sdf version=\"1.7\">\n  <model name=\"" + name +
                       "\">\n    <link name=\"" + name + "\">\n";
    if (file.options.mass) text += sdf_inertial(*file.options.mass);
    if (file.options.visual) text += sdf_shape(file, "visual", kVisual);
    for (const HullArrays& hull : file.hulls) text += sdf_shape(file, "collision", hull.name);
    return text + "    </link>\n  </model>\n</sdf>\n";
}

std::string mjcf_inertial(const BodyMass& body) {
    constexpr std::array<std::size_t, 6> kPlaces = {0, 1, 2, 3, 5, 4};  // xx yy zz xy xz yz
    std::string text = "      <inertial pos=\"" + point_text(body.centre) + "\"" +
                       attribute("mass", body.mass) + " fullinertia=\"";
    for (const std::size_t place : kPlaces) {
        if (text.back() != '"') text += ' ';
        append_number(text, body.inertia[place]);
    }
    return text + "\"/>\n";
}

/// Corners stand in the file; MuJoCo takes the hull of them.
std::string mjcf_text(const RobotFile& file) {
    const std::string name = plain_name(file.path);
    std::string text = "<mujoco model=\"" + name + "\">\n  <asset>\n";
    for (const HullArrays& hull : file.hulls) {
        text += "    <mesh name=\"" + hull.name + "\" scale=\"" + file.scale + "\" vertex=\"";
        for (std::size_t i = 0; i < hull.points.size(); ++i) {
            if (i > 0) text += "  ";
            append_point_text(text, hull.points[i]);
        }
        text += "\"/>\n";
    }
    text += "  </asset>\n  <worldbody>\n    <body name=\"" + name + "\">\n";
    if (file.options.mass) text += mjcf_inertial(*file.options.mass);
    for (const HullArrays& hull : file.hulls) {
        text +=
            "      <geom name=\"" + hull.name + "\" type=\"mesh\" mesh=\"" + hull.name + "\"/>\n";
    }
    return text + "    </body>\n  </worldbody>\n</mujoco>\n";
}

std::string text_in(HullsFormat format, const RobotFile& file) {
    switch (format) {
        case HullsFormat::obj:
            return obj_text(file.hulls);
        case HullsFormat::glb:
            return glb_bytes(file.hulls);
        case HullsFormat::urdf:
            return urdf_text(file);
        case HullsFormat::sdf:
            return sdf_text(file);
        case HullsFormat::mjcf:
            return mjcf_text(file);
    }
    return {};
}

constexpr bool has_meshes(HullsFormat format) {
    return format == HullsFormat::urdf || format == HullsFormat::sdf;
}

/// The files that a URDF or SDF refers to.
Result<Done> write_meshes(const RobotFile& file) {
    const fs::path folder = file.path.parent_path();
    for (const HullArrays& hull : file.hulls) {
        const Result<Done> done =
            write_whole(folder / mesh_name(file.path, hull.name), obj_text({&hull, 1}));
        if (!done) return done.error();
    }
    if (!file.options.visual) return Done{};
    return write_mesh_file(folder / mesh_name(file.path, kVisual), MeshFormat::obj,
                           *file.options.visual);
}

}  // namespace

std::optional<HullsFormat> hulls_format_of(const fs::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".obj") return HullsFormat::obj;
    if (ending == ".glb") return HullsFormat::glb;
    if (ending == ".urdf") return HullsFormat::urdf;
    if (ending == ".sdf") return HullsFormat::sdf;
    if (ending == ".mjcf" || ending == ".xml") return HullsFormat::mjcf;
    return std::nullopt;
}

bool may_replace(const fs::path& path, HullsFormat format, const fs::path& file) {
    if (!has_meshes(format)) return false;
    const auto folder_of = [](const fs::path& of) {
        return fs::absolute(of).lexically_normal().parent_path();
    };
    const std::string name = file.filename().string();
    return folder_of(path) == folder_of(file) && name.starts_with(mesh_stem(path) + "_") &&
           name.ends_with(".obj");
}

Result<std::size_t> write_hulls(const fs::path& path, HullsFormat format,
                                std::span<const HullArrays> hulls,
                                const HullsFileOptions& options) {
    std::vector<HullArrays> written(hulls.begin(), hulls.end());
    if (has_mass(format)) {
        std::erase_if(written, [](const HullArrays& hull) { return hull.dimension < 3; });
    }
    const RobotFile file = {path, written, options,
                            scale_text(options.metres_per_unit > 0 ? options.metres_per_unit : 1)};
    if (has_meshes(format)) {
        const Result<Done> done = write_meshes(file);
        if (!done) return done.error();
    }
    const Result<Done> done = write_whole(path, text_in(format, file));
    if (!done) return done.error();
    return hulls.size() - written.size();
}

}  // namespace cdprep::write
