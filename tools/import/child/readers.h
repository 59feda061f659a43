// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scene.h"

namespace cdprep::import {

/// Whether the name ends like one of the 3D Manufacturing Format and the file is an archive.
[[nodiscard]] bool is_3mf(const std::filesystem::path& path);

/// Reads the meshes of 3MF (core specification 1.3, production extension) that its build items
/// place. Throws std::runtime_error with the reason when a part is missing, when an object has
/// another geometry than triangles, or when the file needs an extension that is not read.
///
/// Over libzip and pugixml, not assimp or lib3mf: assimp 5.2 gives empty scenes for valid files;
/// lib3mf rounds numbers to floats and refuses triangles that use a corner twice.
[[nodiscard]] Scene read_3mf(const std::filesystem::path& path, InputFiles& files);

/// Reads glTF 2.0, as JSON or GLB. Nothing when the file is no glTF, or is glTF 1: then assimp
/// may try. An extension that changes the geometry and is not read is refused by name.
///
/// Of our own because assimp drops triangles with an index out of range without a
/// word and rounds node transforms to floats. Throws std::runtime_error with the
/// reason when the file contradicts itself. Memory stays in proportion to the
/// bytes that the file and its buffers really have.
[[nodiscard]] std::optional<Scene> read_gltf(const std::filesystem::path& path, InputFiles& files);

/// Reads any format that assimp knows. Throws what assimp throws; a file that it
/// refuses is a std::runtime_error with its reason.
[[nodiscard]] Scene read_assimp(const std::string& path, InputFiles& files);

}  // namespace cdprep::import
