// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene_file/json_file.h"
#include "scene_file/scene_file.h"

namespace cdprep::scenes {

/// What a file says and a scene cannot, or what it leaves open. Equal findings are listed once.
class Findings {
public:
    /// "ignored: WHAT". `place` is a JSON pointer.
    void not_taken(const std::string& what, const std::string& place);
    /// "assumed: WHAT".
    void assumed(const std::string& what);

    /// Returns a sentence for each finding: "FILE: ignored: WHAT (/nodes/3/mesh and 2 more)."
    [[nodiscard]] std::vector<std::string> sentences(const std::string& file) const;

private:
    struct Finding {
        std::string words;
        std::string first;  ///< place; empty if it has none
        std::size_t count = 0;
    };
    void add(const std::string& words, const std::string& place);

    std::vector<Finding> findings_;
    std::map<std::string, std::size_t> number_;
};

/// With whom a collider or trigger may collide, by names of systems.
struct GltfFilter {
    std::set<std::string> systems;
    std::optional<std::set<std::string>> with;     ///< set: with these alone
    std::optional<std::set<std::string>> without;  ///< set: not with these

    auto operator<=>(const GltfFilter&) const = default;
};

/// Returns whether both filters let two surfaces collide. A filter refuses a surface unless all
/// systems of that are among `with`. It also refuses one whose systems are all among `without`. A
/// surface in no system is in none of either list.
[[nodiscard]] bool accept(const GltfFilter& a, const GltfFilter& b);

/// The friction of a material that states none, as the draft says.
inline constexpr double kGltfFriction = 0.6;

/// A collider or a trigger, whose geometry is the mesh of its node.
struct GltfSurface {
    GltfFilter filter;
    std::optional<Material> material;
};

/// The motion of a node, in the space of the node. Speeds are in metres per second. The centre is a
/// point as those of the mesh.
struct GltfMotion {
    bool is_kinematic = false;  ///< or its mass is infinite
    std::optional<double> mass;
    std::optional<Double3> centre;  ///< of mass
    Double3 velocity{};
    Double3 turn{};
};

struct GltfNode {
    std::vector<std::uint32_t> children;
    std::optional<std::uint32_t> mesh;
    std::optional<GltfMotion> motion;
    std::optional<GltfSurface> collider;
    std::optional<GltfSurface> trigger;
};

/// The nodes of a glTF document, with what KHR_physics_rigid_bodies says of them.
struct GltfPhysics {
    std::vector<GltfNode> nodes;
    std::vector<std::uint32_t> roots;  ///< of the scene that is read
};

/// Reads a glTF document. Every error names the file, the line and the place. Then the result is of
/// no use. We read the draft of the extension in pull request 2424 of glTF. A geometry is an
/// implicit shape, a node or a mesh; only the mesh of the node itself is taken.
[[nodiscard]] GltfPhysics read_gltf_physics(const JsonFile& file, Findings& findings,
                                            std::vector<std::string>& errors);

}  // namespace cdprep::scenes
