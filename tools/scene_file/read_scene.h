// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene_file/scene_file.h"

namespace cdprep::scenes {

/// A scene file, or every reason why it cannot be read, a sentence each.
struct SceneReading {
    std::optional<SceneFile> scene;
    std::vector<std::string> errors;  ///< empty if and only if there is a scene
};

/// Reads a scene file of the form of scene.schema.json. Paths of models are relative to its
/// folder. An error names the file, the line, the place as a JSON pointer, what was found and what
/// is allowed. If the text is no JSON, that is the only error. Models are not opened.
[[nodiscard]] SceneReading read_scene(const std::filesystem::path& path);

/// The same for a text. `name` is for messages.
[[nodiscard]] SceneReading parse_scene(const std::string& name, const std::string& text,
                                       const std::filesystem::path& folder);

}  // namespace cdprep::scenes
