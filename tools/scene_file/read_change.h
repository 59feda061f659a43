// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "scene_file/json_element.h"
#include "scene_file/scene_file.h"

namespace cdprep::scenes {

/// Reads the members "deform" and "tear" of a motion, an object. Returns nothing if there are none.
/// Adds an error for each mistake; the result is then of no use. Paths are relative to `folder`.
[[nodiscard]] std::optional<Change> read_change(const JsonElement& motion,
                                                const std::filesystem::path& folder);

}  // namespace cdprep::scenes
