// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/gltf_physics.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <tuple>
#include <utility>

#include "scene_file/json_element.h"
#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

using Element = std::optional<JsonElement>;

constexpr std::string_view kPhysics = "KHR_physics_rigid_bodies";
constexpr std::string_view kShapes = "KHR_implicit_shapes";

Element member(const Element& parent, std::string_view key) {
    return parent ? parent->find(key) : std::nullopt;
}

std::vector<JsonElement> items_of(const Element& list) {
    if (!list) return {};
    return list->items().value_or(std::vector<JsonElement>{});
}

std::vector<JsonElement> list_at(const Element& parent, std::string_view key) {
    return items_of(member(parent, key));
}

double number_at(const Element& parent, std::string_view key, Range range, double otherwise) {
    const Element found = member(parent, key);
    return found ? found->number(range).value_or(otherwise) : otherwise;
}

bool truth_at(const Element& parent, std::string_view key) {
    const Element found = member(parent, key);
    return found && found->boolean().value_or(false);
}

std::optional<Double3> vector_at(const Element& parent, std::string_view key) {
    const Element found = member(parent, key);
    return found ? found->vector() : std::nullopt;
}

/// Returns the number of an element of a list that has `count`. `words` names the elements.
std::optional<std::uint32_t> reference(const Element& element, std::size_t count,
                                       const std::string& words) {
    if (!element) return std::nullopt;
    const auto found = element->whole(0);
    if (!found || *found < count) return found;
    element->refuse("found " + std::to_string(*found) + ", but " +
                    (count == 0 ? "the file has no " + words + "."
                                : "the last of the " + words + " is number " +
                                      std::to_string(count - 1) + "."));
    return std::nullopt;
}

/// Reads one document.
class PhysicsReader {
public:
    PhysicsReader(const JsonFile& file, Findings& findings, std::vector<std::string>& errors)
        : root_(JsonElement(file, errors)), findings_(findings) {}

    GltfPhysics read() {
        if (!root_->keys()) return {};
        nodes_ = list_at(root_, "nodes");
        meshes_ = list_at(root_, "meshes");
        const Element extensions = root_->find("extensions");
        shapes_ = list_at(member(extensions, kShapes), "shapes");
        const Element physics = member(extensions, kPhysics);
        list_unknown(physics, {"physicsMaterials", "collisionFilters", "physicsJoints"});
        joint_count_ = list_at(physics, "physicsJoints").size();
        read_filters(physics);
        read_materials(physics);
        result_.nodes.resize(nodes_.size());
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) read_tree(i);
        find_meshes_below();
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) read_node(i);
        read_roots();
        list_animations();
        return std::move(result_);
    }

private:
    // --- The tree --------------------------------------------------------------------

    void read_tree(std::uint32_t number) {
        const JsonElement& node = nodes_[number];
        if (!node.keys()) return;
        result_.nodes[number].mesh = reference(node.find("mesh"), meshes_.size(), "meshes");
        result_.nodes[number].children = references(node.find("children"));
    }

    [[nodiscard]] std::vector<std::uint32_t> references(const Element& list) const {
        std::vector<std::uint32_t> numbers;
        for (const JsonElement& item : items_of(list)) {
            if (const auto number = reference(item, nodes_.size(), "nodes")) {
                numbers.push_back(*number);
            }
        }
        return numbers;
    }

    /// As tools/import reads them: of the scene that the file names, or of its first one. Without
    /// scenes, all nodes that are no children.
    void read_roots() {
        const std::vector<JsonElement> scenes = list_at(root_, "scenes");
        if (!scenes.empty()) {
            const Element chosen = root_->find("scene");
            const auto scene = chosen ? reference(chosen, scenes.size(), "scenes") : 0U;
            if (scene) result_.roots = references(scenes[*scene].find("nodes"));
            return;
        }
        std::vector<bool> is_child(nodes_.size(), false);
        for (const GltfNode& node : result_.nodes) {
            for (const std::uint32_t child : node.children) is_child[child] = true;
        }
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            if (!is_child[i]) result_.roots.push_back(i);
        }
    }

    /// Notes above which nodes there are meshes. The tree may have cycles: it is not checked yet.
    void find_meshes_below() {
        std::vector<std::vector<std::uint32_t>> parents(nodes_.size());
        std::vector<std::uint32_t> pending;
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            for (const std::uint32_t child : result_.nodes[i].children) parents[child].push_back(i);
            if (result_.nodes[i].mesh) pending.push_back(i);
        }
        has_meshes_below_.resize(nodes_.size(), false);
        while (!pending.empty()) {
            const std::uint32_t node = pending.back();
            pending.pop_back();
            for (const std::uint32_t parent : parents[node]) {
                if (has_meshes_below_[parent]) continue;
                has_meshes_below_[parent] = true;
                pending.push_back(parent);
            }
        }
    }

    // --- What objects share ----------------------------------------------------------

    void read_filters(const Element& physics) {
        for (const JsonElement& element : list_at(physics, "collisionFilters")) {
            list_unknown(element,
                         {"collisionSystems", "collideWithSystems", "notCollideWithSystems"});
            filters_.push_back({names_at(element, "collisionSystems").value_or(Names{}),
                                names_at(element, "collideWithSystems"),
                                names_at(element, "notCollideWithSystems")});
        }
    }

    using Names = std::set<std::string>;

    static std::optional<Names> names_at(const Element& parent, std::string_view key) {
        const Element list = member(parent, key);
        if (!list) return std::nullopt;
        Names names;
        for (const JsonElement& name : items_of(list)) names.insert(name.text().value_or(""));
        return names;
    }

    void read_materials(const Element& physics) {
        for (const JsonElement& element : list_at(physics, "physicsMaterials")) {
            materials_.push_back(read_material(element));
        }
    }

    /// The defaults are the draft's.
    Material read_material(const JsonElement& element) {
        list_unknown(element, {"staticFriction", "dynamicFriction", "restitution",
                               "frictionCombine", "restitutionCombine"});
        Material material;
        material.friction =
            number_at(element, "dynamicFriction", Range::zero_or_more, kGltfFriction);
        material.restitution = number_at(element, "restitution", Range::zero_or_more, 0);
        const double other =
            number_at(element, "staticFriction", Range::zero_or_more, kGltfFriction);
        if (other != material.friction) {
            findings_.not_taken("a static friction other than the dynamic one, which is used",
                                element.pointer() + ": " + report::number_text(other) +
                                    " instead of " + report::number_text(material.friction));
        }
        if (material.restitution > 1) {
            list("a restitution above 1; 1 is used", *element.find("restitution"));
            material.restitution = 1;
        }
        static const std::vector<std::string> words = {"average", "minimum", "maximum", "multiply"};
        if (const Element rule = element.find("frictionCombine")) {
            const bool is_read = rule->one_of(words, "a combine mode").has_value();
            if (is_read) {
                list("a friction combine mode; the geometric mean is used", *rule);
            }
        }
        if (const Element rule = element.find("restitutionCombine")) {
            const auto word = rule->one_of(words, "a combine mode");
            if (word && words[*word] != "maximum") {
                list("a restitution combine mode; the larger restitution is used", *rule);
            }
        }
        return material;
    }

    // --- Nodes -----------------------------------------------------------------------

    void read_node(std::uint32_t number) {
        const JsonElement& element = nodes_[number];
        const Element physics = member(element.find("extensions"), kPhysics);
        if (!physics || !physics->keys()) return;
        list_unknown(physics, {"motion", "collider", "trigger", "joint"});
        GltfNode& node = result_.nodes[number];
        if (const Element motion = physics->find("motion")) node.motion = read_motion(*motion);
        if (const Element collider = physics->find("collider")) {
            node.collider = read_surface(*collider, number, "collider");
        }
        if (const Element trigger = physics->find("trigger")) {
            node.trigger = read_surface(*trigger, number, "trigger");
        }
        if (const Element joint = physics->find("joint"); joint && joint->keys()) {
            static_cast<void>(reference(joint->find("joint"), joint_count_, "joints"));
            static_cast<void>(reference(joint->find("connectedNode"), nodes_.size(), "nodes"));
            findings_.not_taken("a joint", joint->pointer());
        }
        if (!node.collider && !node.trigger) return;
        if (const Element skin = element.find("skin")) {
            findings_.not_taken("a skin that moves; the mesh keeps the pose of the file",
                                skin->pointer());
        }
    }

    std::optional<GltfMotion> read_motion(const JsonElement& element) {
        if (!element.keys()) return std::nullopt;
        list_unknown(element,
                     {"isKinematic", "mass", "centerOfMass", "inertiaDiagonal",
                      "inertiaOrientation", "linearVelocity", "angularVelocity", "gravityFactor"});
        GltfMotion motion;
        motion.is_kinematic = truth_at(element, "isKinematic");
        motion.velocity = vector_at(element, "linearVelocity").value_or(Double3{});
        motion.turn = vector_at(element, "angularVelocity").value_or(Double3{});
        motion.centre = vector_at(element, "centerOfMass");
        const Element mass = element.find("mass");
        if (mass) motion.mass = mass->number(Range::zero_or_more);
        const double gravity = number_at(element, "gravityFactor", Range::any, 1);
        if (motion.is_kinematic) return motion;
        if (motion.mass == 0) {
            motion.is_kinematic = true;
            findings_.not_taken(
                "an infinite mass (0); the body is kinematic instead, so gravity "
                "does not move it",
                mass->pointer());
            return motion;
        }
        if (gravity != 1) {
            list("a gravity factor other than 1", *element.find("gravityFactor"));
        }
        list_inertia(element);
        return motion;
    }

    void list_inertia(const JsonElement& motion) {
        for (const auto& [key, count, words] :
             {std::tuple{"centerOfMass", 3U, "a centre of mass"},
              std::tuple{"inertiaDiagonal", 3U, "an inertia"},
              std::tuple{"inertiaOrientation", 4U, "a rotation of the inertia"}}) {
            const Element element = motion.find(key);
            if (!element || !element->numbers(count)) continue;
            list(std::string(words) + "; that of the model is used", *element);
        }
    }

    /// Returns nothing if the geometry is not taken, and lists it.
    std::optional<GltfSurface> read_surface(const JsonElement& element, std::uint32_t node,
                                            const std::string& kind) {
        if (!element.keys()) return std::nullopt;
        const bool is_trigger = kind == "trigger";
        list_unknown(element,
                     is_trigger ? Keys{"geometry", "shape", "nodes", "collisionFilter"}
                                : Keys{"geometry", "shape", "physicsMaterial", "collisionFilter"});
        GltfSurface surface;
        if (const auto filter =
                reference(element.find("collisionFilter"), filters_.size(), "collision filters")) {
            surface.filter = filters_[*filter];
        }
        if (const auto material = reference(element.find("physicsMaterial"), materials_.size(),
                                            "physics materials")) {
            surface.material = materials_[*material];
        }
        if (const Element parts = element.find("nodes"); parts && is_trigger) {
            static_cast<void>(references(parts));
            findings_.not_taken("a trigger of several nodes; each of them has its own events",
                                parts->pointer());
            if (!element.find("geometry")) return std::nullopt;
        }
        if (!takes_geometry(element, node, kind)) return std::nullopt;
        return surface;
    }

    /// Returns whether the mesh of the node is the geometry of its collider or trigger. Lists other
    /// geometry.
    bool takes_geometry(const JsonElement& surface, std::uint32_t node, const std::string& kind) {
        if (const Element shape = surface.find("shape"); shape && !surface.find("geometry")) {
            return takes_mesh_instead("the shape of an older draft", shape->pointer(), node, kind);
        }
        const Element geometry = surface.require("geometry");
        if (!geometry || !geometry->keys()) return false;
        list_unknown(geometry, {"shape", "node", "mesh", "convexHull"});
        const Element shape = geometry->find("shape");
        const Element other = geometry->find("node");
        const Element mesh = geometry->find("mesh");
        const int count = int{shape.has_value()} + int{other.has_value()} + int{mesh.has_value()};
        if (count != 1) {
            geometry->refuse("found " + std::to_string(count) +
                             " of 'shape', 'node' and 'mesh'; expected 1.");
            return false;
        }
        if (shape) return takes_shape(*shape, node, kind);
        bool is_own = false;
        if (mesh) {
            const auto number = reference(mesh, meshes_.size(), "meshes");
            if (!number) return false;
            is_own = result_.nodes[node].mesh == number;
        } else {
            const auto number = reference(other, nodes_.size(), "nodes");
            if (!number) return false;
            is_own =
                result_.nodes[node].mesh && result_.nodes[*number].mesh == result_.nodes[node].mesh;
            if (has_meshes_below_[*number]) {
                findings_.not_taken("meshes below the node of a geometry", other->pointer());
            }
        }
        const std::string place = (mesh ? mesh : other)->pointer();
        if (truth_at(geometry, "convexHull")) {
            findings_.not_taken("a convex hull as geometry; the mesh is used", place);
        }
        return is_own || takes_mesh_instead("a mesh other than the node's", place, node, kind);
    }

    bool takes_shape(const JsonElement& shape, std::uint32_t node, const std::string& kind) {
        const auto number = reference(shape, shapes_.size(), "implicit shapes");
        if (!number) return false;
        const Element type = shapes_[*number].find("type");
        const std::string words = type ? type->text().value_or("") : "";
        return takes_mesh_instead("an implicit shape" + (words.empty() ? "" : " (" + words + ")"),
                                  shape.pointer(), node, kind);
    }

    bool takes_mesh_instead(const std::string& what, const std::string& place, std::uint32_t node,
                            const std::string& kind) {
        const bool has_mesh = result_.nodes[node].mesh.has_value();
        findings_.not_taken(
            what + (has_mesh ? "; the mesh of its node is used"
                             : "; its node has no mesh, so the " + kind + " is left out"),
            place);
        return has_mesh;
    }

    // --- What is listed --------------------------------------------------------------

    /// Lists a value that is not taken.
    void list(const std::string& what, const JsonElement& value) {
        findings_.not_taken(what, value.pointer() + ": " + value.value_text());
    }

    using Keys = std::initializer_list<std::string_view>;

    /// Lists the keys of an object that neither the draft nor every glTF object has.
    void list_unknown(const Element& element, Keys known) {
        const auto keys = element ? element->keys() : std::nullopt;
        if (!keys) return;
        for (const std::string& key : *keys) {
            if (key == "name" || key == "extras") continue;
            if (std::find(known.begin(), known.end(), key) != known.end()) continue;
            findings_.not_taken("the unknown key '" + key + "'",
                                pointer_below(element->pointer(), key));
        }
    }

    void list_animations() {
        for (const JsonElement& animation : list_at(root_, "animations")) {
            for (const JsonElement& channel : list_at(animation, "channels")) {
                findings_.not_taken("an animation of a node", channel.pointer());
            }
        }
    }

    Element root_;
    Findings& findings_;
    GltfPhysics result_;
    std::vector<JsonElement> nodes_;
    std::vector<bool> has_meshes_below_;  ///< by node
    std::vector<JsonElement> shapes_;
    std::vector<JsonElement> meshes_;
    std::size_t joint_count_ = 0;
    std::vector<GltfFilter> filters_;
    std::vector<Material> materials_;
};

/// Returns whether a filter accepts a surface that is in these systems.
bool accepts(const GltfFilter& filter, const std::set<std::string>& systems) {
    const auto has_all = [&](const std::set<std::string>& names) {
        return !systems.empty() && std::ranges::includes(names, systems);
    };
    if (filter.with && !has_all(*filter.with)) return false;
    return !filter.without || !has_all(*filter.without);
}

}  // namespace

void Findings::not_taken(const std::string& what, const std::string& place) {
    add("ignored: " + what, place);
}

void Findings::assumed(const std::string& what) {
    add("assumed: " + what, "");
}

void Findings::add(const std::string& words, const std::string& place) {
    const auto [at, is_new] = number_.try_emplace(words, findings_.size());
    if (is_new) findings_.push_back({words, place, 0});
    ++findings_[at->second].count;
}

std::vector<std::string> Findings::sentences(const std::string& file) const {
    std::vector<std::string> sentences;
    for (const Finding& finding : findings_) {
        std::string text = file + ": " + finding.words;
        if (!finding.first.empty()) {
            text += " (" + finding.first;
            if (finding.count > 1) text += " and " + std::to_string(finding.count - 1) + " more";
            text += ")";
        }
        sentences.push_back(text + ".");
    }
    return sentences;
}

bool accept(const GltfFilter& a, const GltfFilter& b) {
    return accepts(a, b.systems) && accepts(b, a.systems);
}

GltfPhysics read_gltf_physics(const JsonFile& file, Findings& findings,
                              std::vector<std::string>& errors) {
    return PhysicsReader(file, findings, errors).read();
}

}  // namespace cdprep::scenes
