// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "import/import_file.h"
#include "import/scene_bytes.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Returns the header if `bytes` begin with one and have exactly the length that its counts give.
[[nodiscard]] std::optional<SceneHeader> read_scene_header(
    std::span<const std::byte> bytes) noexcept;

/// Makes a soup of the child's result. Checks every count and reference, walks the nodes depth
/// first, applies their transforms in double and reverses faces under mirroring transforms.
///
/// Meshes without triangles leave no instance. A scene is single precision if every used
/// transform is the identity and every used mesh is single precision. `bytes` must have an
/// outcome of `read`. Fails with `unreadable` on any inconsistency in them.
[[nodiscard]] Result<mesh::TriangleSoup> flatten_scene(const SourceFile& file,
                                                       std::span<const std::byte> bytes,
                                                       const ImportOptions& options);

}  // namespace cdprep::import
