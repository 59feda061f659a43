// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/run/unpaired_layers.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {

std::vector<UnpairedLayers> unpaired_layers(const scenes::SceneFile& scene) {
    std::vector<std::uint64_t> objects(scene.layers.size());
    for (const scenes::FileObject& object : scene.objects) ++objects[object.layer];
    std::vector<UnpairedLayers> unpaired;
    for (std::uint32_t a = 0; a < objects.size(); ++a) {
        for (std::uint32_t b = a; b < objects.size(); ++b) {
            const bool is_asked = std::ranges::any_of(scene.pairs, [&](const auto& pair) {
                return std::minmax(pair.asked.a, pair.asked.b) == std::minmax(a, b) &&
                       pair.asked.effects != Ask::nothing;
            });
            const std::uint64_t pairs =
                a == b ? objects[a] * (std::max<std::uint64_t>(objects[a], 1) - 1) / 2
                       : objects[a] * objects[b];
            if (!is_asked && pairs > 0) unpaired.push_back({a, b, pairs});
        }
    }
    return unpaired;
}

nlohmann::ordered_json unpaired_json(const scenes::SceneFile& scene) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const UnpairedLayers& layers : unpaired_layers(scene)) {
        json.push_back({{"layers", {scene.layers[layers.a], scene.layers[layers.b]}},
                        {"pairs", layers.pairs}});
    }
    return json;
}

std::string unpaired_text(const scenes::SceneFile& scene) {
    std::string text;
    for (const UnpairedLayers& layers : unpaired_layers(scene)) {
        text += (text.empty() ? "layers never tested against each other: " : ", ") +
                printable(scene.layers[layers.a]) + "-" + printable(scene.layers[layers.b]) + " (" +
                counted(layers.pairs, "pair", "pairs") + " of objects)";
    }
    return text.empty() ? text : text + "\n";
}

std::vector<std::string> layers_in_no_pair(const scenes::SceneFile& scene) {
    std::vector<std::string> names;
    for (std::uint32_t layer = 0; layer < scene.layers.size(); ++layer) {
        const bool is_asked = std::ranges::any_of(scene.pairs, [&](const auto& pair) {
            return (pair.asked.a == layer || pair.asked.b == layer) &&
                   pair.asked.effects != Ask::nothing;
        });
        if (!is_asked) names.push_back(scene.layers[layer]);
    }
    return names;
}

}  // namespace cdprep::report
