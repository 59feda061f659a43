// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "scene.h"

namespace cdprep::import {

/// Tells why a file cannot be read.
[[noreturn]] inline void fail(const std::string& why) {
    throw std::runtime_error(why);
}

/// Returns true if the name has the extension of the 3D Manufacturing Format and the file is an
/// archive.
[[nodiscard]] bool is_3mf(const std::filesystem::path& path);

/// Reads the meshes of 3MF (core specification 1.3, production extension) that its build items
/// place. Throws std::runtime_error with the reason if a part is missing or the file requires an
/// unsupported extension. Also throws it if an object has other geometry than triangles.
///
/// Uses libzip and pugixml instead of assimp or lib3mf. assimp 5.2 returns empty scenes for valid
/// files. lib3mf rounds numbers to floats and refuses triangles that use a corner twice.
[[nodiscard]] Scene read_3mf(const std::filesystem::path& path, InputFiles& files);

/// Reads glTF 2.0, as JSON or GLB. Returns nothing if the file is not glTF or is glTF 1; assimp
/// may then try. Throws std::runtime_error with the reason if the file contradicts itself. Throws
/// it with the name of an unsupported extension that changes the geometry.
///
/// Meshes have the pose of the file: morph targets with their weights, then skins with their
/// joints where the nodes place them. Animations do not count.
///
/// We do not use assimp here: it silently drops triangles with an index out of range and rounds
/// node transforms to floats. Memory is proportional to the actual bytes of the file and its
/// buffers.
[[nodiscard]] std::optional<Scene> read_gltf(const std::filesystem::path& path, InputFiles& files);

/// Reads any format that assimp supports. Skins and morph targets are not applied, but
/// Scene::unposed_meshes counts the meshes that have them. Passes on the exceptions of assimp.
/// Throws std::runtime_error with the reason if assimp refuses the file.
[[nodiscard]] Scene read_assimp(const std::string& path, InputFiles& files);

}  // namespace cdprep::import
