// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene_file/scene_file.h"

namespace cdprep::report {

/// Two layers that no pair names, or a pair without effects.
struct UnpairedLayers {
    std::uint32_t a;
    std::uint32_t b;
    std::uint64_t pairs;  ///< of their objects
};

/// Returns the layers whose objects are never tested against each other, if they have any.
[[nodiscard]] std::vector<UnpairedLayers> unpaired_layers(const scenes::SceneFile& scene);

/// Returns the same as JSON (simulate.schema.json), and as a line of text or nothing.
[[nodiscard]] nlohmann::ordered_json unpaired_json(const scenes::SceneFile& scene);
[[nodiscard]] std::string unpaired_text(const scenes::SceneFile& scene);

/// Returns the names of the layers that are in no pair with effects, not even with themselves.
[[nodiscard]] std::vector<std::string> layers_in_no_pair(const scenes::SceneFile& scene);

}  // namespace cdprep::report
