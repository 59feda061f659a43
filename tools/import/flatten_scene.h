// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "import/import_file.h"
#include "import/scene_bytes.h"
#include "import/source_file.h"

namespace cdprep::import {

/// The header, if `bytes` begin with one and are as long as its counts say.
[[nodiscard]] std::optional<SceneHeader> read_scene_header(
    std::span<const std::byte> bytes) noexcept;

/// Makes a soup of what the child wrote: checks every count and reference, walks
/// the nodes depth first, applies their transforms in double and reverses faces
/// where they mirror.
///
/// Meshes without triangles leave no instance. A scene in which every used
/// transform is the identity is single precision. `bytes` must have an outcome of
/// `read`; anything inconsistent in them is `unreadable`.
[[nodiscard]] Result<mesh::TriangleSoup> flatten_scene(const SourceFile& file,
                                                       std::span<const std::byte> bytes,
                                                       const ImportOptions& options);

}  // namespace cdprep::import
