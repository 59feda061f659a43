// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "scene.h"

namespace cdprep::import {

/// Reads glTF 2.0, as JSON or GLB. Nothing when the file is none, or needs
/// extensions, sparse or compressed accessors: then assimp may try.
///
/// Of our own because assimp drops triangles with an index out of range without a
/// word and rounds node transforms to floats. Throws std::runtime_error with the
/// reason when the file contradicts itself. Memory stays in proportion to the
/// bytes that the file and its buffers really have.
[[nodiscard]] std::optional<Scene> read_gltf(const std::filesystem::path& path,
                                             std::uint64_t& input_bytes);

}  // namespace cdprep::import
