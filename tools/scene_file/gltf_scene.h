// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/result.h"
#include "import/import_file.h"
#include "scene_file/read_assembly.h"

namespace cdprep::scenes {

/// A glTF file as a scene that moves, or every reason why it cannot be one.
struct GltfReading {
    std::optional<AssemblyScene> assembly;
    std::vector<std::string> findings;  ///< a sentence each: what is not taken or assumed
    std::vector<Error> errors;          ///< empty if and only if there is an assembly
};

/// Reads a glTF file (.gltf or .glb) with its extension KHR_physics_rigid_bodies. Each node with a
/// collider or a trigger and triggers is an object; other nodes are left out.
///
/// Objects whose filters are equal share a layer, but bodies, other colliders and triggers have
/// layers of their own. Layers ask for `response` if their filters accept each other, both have
/// colliders and one has bodies. They ask for `collide`, of solids, between triggers and colliders.
///
/// A kinematic node moves all nodes below it steadily. Another node with a motion is a body.
/// Several colliders of a body become one object if their filters and materials are equal.
/// Otherwise they stay where they are. Velocities become model units. Gravity is 9.81 m/s^2
/// downwards, a step 1/60 s, a run 1 s. Dynamics::most_speed is at least 2 m/s. It is twice
/// the speed of a fall from the highest point of all bodies to the lowest of the scene.
///
/// SceneFile::text is the JSON of the file.
[[nodiscard]] GltfReading read_gltf_scene(const std::filesystem::path& path,
                                          const import::ImportOptions& options);

}  // namespace cdprep::scenes
