// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "import/mesh_endings.h"
#include "import/parse_number.h"
#include "zip_file.h"

namespace cdprep::import {
namespace {

/// Returns "path" for "p:path". The document chooses the prefix of a namespace.
std::string_view local_name(std::string_view name) {
    return name.substr(name.rfind(':') + 1);
}

pugi::xml_node child(const pugi::xml_node& parent, std::string_view name) {
    return parent.find_child([&](const pugi::xml_node& n) { return local_name(n.name()) == name; });
}

std::string_view attribute(const pugi::xml_node& node, std::string_view name) {
    return node
        .find_attribute([&](const pugi::xml_attribute& a) { return local_name(a.name()) == name; })
        .value();
}

/// Returns "3D/parts/a.model" for "/3D/parts/a.model".
std::string entry_name(std::string_view path) {
    return std::string(path.starts_with('/') ? path.substr(1) : path);
}

std::uint32_t index_of(const pugi::xml_node& triangle, const char* name) {
    constexpr std::int64_t kNone = 0xffffffff;  // of no mesh: reported as out of range
    const std::string_view text = triangle.attribute(name).value();
    const WholeNumber number = parse_whole_number(text.data(), text.data() + text.size());
    if (!number.next || number.value < 0) {
        fail("a triangle has " + std::string(name) + "=\"" + std::string(text) +
             "\", which is not a vertex number");
    }
    return static_cast<std::uint32_t>(std::min(number.value, kNone));
}

/// Returns the transform of a node as a matrix for column vectors. The file's twelve numbers are
/// the rows of a matrix for row vectors.
Matrix transform_of(const pugi::xml_node& node) {
    const std::string_view text = node.attribute("transform").value();
    if (text.empty()) return kIdentity;
    Matrix result = kIdentity;
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < 12; ++i) {
        while (at < end && *at <= ' ') ++at;
        const Number number = parse_number(at, end);
        if (!number.next || !std::isfinite(number.value)) {
            fail("found the transform \"" + std::string(text) + "\"; expected 12 finite numbers");
        }
        result[4 * (i % 3) + i / 3] = number.value;
        at = number.next;
    }
    return result;
}

double metres_of(std::string_view unit) {
    static const std::map<std::string_view, double> kUnits = {
        {"", 1e-3},       {"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2},
        {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1}};
    const auto found = kUnits.find(unit);
    if (found == kUnits.end()) fail("its unit is \"" + std::string(unit) + "\", not a unit of 3MF");
    return found->second;
}

/// Refuses an extension that the model requires, unless this reader supports it or it changes no
/// geometry.
void check_extensions(const pugi::xml_node& model) {
    constexpr std::array<std::string_view, 3> kRead = {"/core/", "/production/", "/material/"};
    std::string_view prefixes = attribute(model, "requiredextensions");
    while (!prefixes.empty()) {
        const std::size_t end = std::min(prefixes.find(' '), prefixes.size());
        const std::string prefix(prefixes.substr(0, end));
        prefixes.remove_prefix(std::min(end + 1, prefixes.size()));
        const std::string_view uri = model.attribute(("xmlns:" + prefix).c_str()).value();
        bool is_read = prefix.empty();
        for (const std::string_view part : kRead) is_read |= uri.find(part) != uri.npos;
        if (!is_read)
            fail("it needs the extension " + std::string(uri.empty() ? prefix : uri) +
                 ", which is not supported");
    }
}

/// The parts of one package, and the scene that its build items make.
class PackageReader {
public:
    PackageReader(const std::filesystem::path& path, InputFiles& files)
        : zip_(path), files_(files) {}

    Scene read() {
        const std::string root = root_part();
        const pugi::xml_node model = part(root);
        scene_.metres_per_unit = metres_of(attribute(model, "unit"));
        scene_.up_axis = format::UpAxis::z;
        add_node("build", kNoParent, kIdentity);
        for (const pugi::xml_node& item : child(model, "build").children()) {
            if (local_name(item.name()) == "item") place(item, root, 0, 0);
        }
        return std::move(scene_);
    }

private:
    /// Returns the root model of the package, found from its relationships.
    [[nodiscard]] std::string root_part() {
        const pugi::xml_node relationships = document("_rels/.rels");
        for (const pugi::xml_node& one : child(relationships, "Relationships").children()) {
            const std::string_view type = attribute(one, "Type");
            if (type.ends_with("/3dmodel")) return entry_name(attribute(one, "Target"));
        }
        fail("its package has no 3D model");
    }

    /// Returns an XML document of the package. It is kept, so no document is read twice.
    pugi::xml_node document(const std::string& name) {
        const auto [kept, is_new] = documents_.try_emplace(name);
        if (!is_new) return kept->second;
        std::string bytes = zip_.read(name);
        files_.note_part(bytes.size());
        // Only numbers and names are used: no comments, no entities of a document type.
        const pugi::xml_parse_result result =
            kept->second.load_buffer(bytes.data(), bytes.size(), pugi::parse_default);
        if (!result) {
            fail("its part " + name + " is not XML at byte " + std::to_string(result.offset) +
                 ": " + result.description());
        }
        return kept->second;
    }

    /// Returns the model element of a part, and indexes its objects by number.
    pugi::xml_node part(const std::string& name) {
        const pugi::xml_node model = child(document(name), "model");
        if (!model) fail("its part " + name + " has no model");
        if (!objects_.try_emplace(name).second) return model;
        check_extensions(model);
        for (const pugi::xml_node& object : child(model, "resources").children()) {
            if (local_name(object.name()) != "object") continue;
            objects_[name][std::string(attribute(object, "id"))] = object;
        }
        return model;
    }

    /// Adds below a node the object to which an item or a component refers.
    void place(const pugi::xml_node& use, const std::string& in, std::uint32_t parent,
               std::size_t depth) {
        constexpr std::size_t kMaxDepth = 200;
        const std::string_view path = attribute(use, "path");
        const std::string name = path.empty() ? in : entry_name(path);
        part(name);
        const std::string id(attribute(use, "objectid"));
        const auto found = objects_[name].find(id);
        const std::string object_name = "object " + id + " of " + name;
        if (found == objects_[name].end()) fail(object_name + " does not exist");
        if (depth > kMaxDepth) fail(object_name + " contains itself, or is nested too deeply");
        const pugi::xml_node object = found->second;
        const std::string_view title = attribute(object, "name");
        const std::uint32_t node = add_node(title.empty() ? "object_" + id : std::string(title),
                                            parent, transform_of(use));
        if (child(object, "mesh")) {
            scene_.nodes[node].meshes.push_back(mesh_of(name, object));
        } else if (child(object, "components")) {
            for (const pugi::xml_node& component : child(object, "components").children()) {
                if (local_name(component.name()) == "component") {
                    place(component, name, node, depth + 1);
                }
            }
        } else {
            fail(object_name + " has neither triangles nor components; nothing else is supported");
        }
    }

    std::uint32_t add_node(std::string name, std::uint32_t parent, const Matrix& transform) {
        constexpr std::size_t kMaxUses = 1'000'000;  // components of components multiply
        if (scene_.nodes.size() >= kMaxUses) {
            fail("its objects are used more than " + std::to_string(kMaxUses) + " times");
        }
        const auto number = static_cast<std::uint32_t>(scene_.nodes.size());
        scene_.nodes.push_back({std::move(name), parent, transform, {}});
        return number;
    }

    /// Returns the number of an object's mesh. Several uses of the object share it.
    std::uint32_t mesh_of(const std::string& part_name, const pugi::xml_node& object) {
        const auto number = static_cast<std::uint32_t>(scene_.meshes.size());
        const auto [known, is_new] = meshes_.try_emplace(object.internal_object(), number);
        if (is_new) scene_.meshes.push_back(read_mesh(part_name, child(object, "mesh")));
        return known->second;
    }

    static Scene::Mesh read_mesh(const std::string& part_name, const pugi::xml_node& from) {
        if (child(from, "beamlattice"))
            fail("a mesh of " + part_name + " has beams, which are not supported");
        Scene::Mesh mesh;
        for (const pugi::xml_node& vertex : child(from, "vertices").children()) {
            if (local_name(vertex.name()) == "vertex") add_vertex(vertex, mesh);
        }
        for (const pugi::xml_node& triangle : child(from, "triangles").children()) {
            if (local_name(triangle.name()) != "triangle") continue;
            for (const char* const corner : {"v1", "v2", "v3"}) {
                mesh.corners.push_back(index_of(triangle, corner));
            }
            mesh.sizes.push_back(3);
        }
        return mesh;
    }

    static void add_vertex(const pugi::xml_node& vertex, Scene::Mesh& mesh) {
        std::array<double, 3> p{};
        constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::string_view text = vertex.attribute(kAxes[axis]).value();
            const Number number = parse_number(text.data(), text.data() + text.size());
            if (!number.next) {
                fail("a vertex has " + std::string(kAxes[axis]) + "=\"" + std::string(text) +
                     "\", which is not a number");
            }
            p[axis] = number.value;
            mesh.is_single &= number.single;
        }
        mesh.vertices.push_back(p);
    }

    ZipFile zip_;
    InputFiles& files_;
    std::map<std::string, pugi::xml_document> documents_;
    std::map<std::string, std::map<std::string, pugi::xml_node>> objects_;  ///< by part and number
    std::map<const void*, std::uint32_t> meshes_;
    Scene scene_;
};

}  // namespace

bool is_3mf(const std::filesystem::path& path) {
    std::array<char, 2> start{};
    std::ifstream(path, std::ios::binary).read(start.data(), start.size());
    return lower_extension(path) == ".3mf" && start == std::array<char, 2>{'P', 'K'};
}

Scene read_3mf(const std::filesystem::path& path, InputFiles& files) {
    files.note_opened(path, std::filesystem::file_size(path));
    return PackageReader(path, files).read();
}

}  // namespace cdprep::import
