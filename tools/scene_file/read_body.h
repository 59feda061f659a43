// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "scene_file/json_element.h"
#include "scene_file/scene_file.h"

namespace cdprep::scenes {

/// Reads a motion that is "body", or an object with the member "body". Returns nothing for another
/// motion. Adds an error for each mistake; the result is then of no use.
[[nodiscard]] std::optional<BodyMotion> read_body(const JsonElement& motion);

/// Reads the member "material" of an object.
[[nodiscard]] Material read_material(const JsonElement& object);

/// Reads the members "gravity" and "dynamics" of a scene file.
[[nodiscard]] Dynamics read_dynamics(const JsonElement& root);

}  // namespace cdprep::scenes
