// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/format/file_header.h"
#include "import/scene_bytes.h"
#include "input_files.h"

namespace cdprep::import {

using Matrix = std::array<double, 16>;  ///< row by row
inline constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// The result of an importer in the child, before it is sent to the parent.
struct Scene {
    struct Mesh {
        std::vector<std::array<double, 3>> vertices;
        std::vector<std::uint32_t> sizes;    ///< corners per face
        std::vector<std::uint32_t> corners;  ///< any number, in range or not
        std::uint32_t material = 0xffffffff;
        bool is_single = true;  ///< every coordinate is a float without loss
    };
    struct Node {
        std::string name;
        std::uint32_t parent = kNoParent;  ///< precedes this node
        Matrix parent_from_node{};
        std::vector<std::uint32_t> meshes;
        bool is_posed = false;  ///< a skin places its meshes; its transforms do not
    };
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;  ///< depth first
    std::vector<std::string> materials;
    std::uint64_t unposed_meshes = 0;       ///< with a skin or morph weights that are not applied
    std::uint64_t weightless_vertices = 0;  ///< of skins: all their joint weights are 0
    double metres_per_unit = 0;
    format::UpAxis up_axis = format::UpAxis::unknown;
};

/// Writes the scene to the parent's descriptor in the form of scene_bytes.h.
[[nodiscard]] bool write_scene(const Scene& scene, const InputFiles& files);

/// Writes an outcome without a scene, and the reason.
[[nodiscard]] bool write_failure(SceneOutcome outcome, std::string_view why,
                                 const InputFiles& files);

}  // namespace cdprep::import
