// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "scene.h"

namespace cdprep::import {

/// Reads glTF 2.0, as JSON or GLB. Nothing when the file is no glTF, or is glTF 1: then assimp
/// may try. An extension that changes the geometry and is not read is refused by name.
///
/// Of our own because assimp drops triangles with an index out of range without a
/// word and rounds node transforms to floats. Throws std::runtime_error with the
/// reason when the file contradicts itself. Memory stays in proportion to the
/// bytes that the file and its buffers really have.
[[nodiscard]] std::optional<Scene> read_gltf(const std::filesystem::path& path, InputFiles& files);

}  // namespace cdprep::import
