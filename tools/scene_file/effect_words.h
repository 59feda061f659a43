// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cdprep/plan.h"

namespace cdprep::scenes {

/// The effects that a scene file may ask for. A scene refuses `inside`, which is about points.
inline constexpr Ask kSceneAsks = [] {
    Ask asks = kSceneChanges | Ask::response | Ask::inside;
    for (const Ask effect : kSceneEffects) asks = asks | effect;
    return asks;
}();

/// Returns the names of kSceneAsks.
[[nodiscard]] inline std::vector<std::string> effect_words() {
    std::vector<std::string> words;
    for (const Needs& row : needs()) {
        if (contains(kSceneAsks, row.ask)) words.emplace_back(row.name);
    }
    return words;
}

/// Returns the bit of an effect, or nothing if there is no such effect.
[[nodiscard]] inline Ask effect_of(const std::string& word) noexcept {
    const Needs* row = find_needs(std::string_view(word));
    return row == nullptr ? Ask::nothing : row->ask;
}

/// Returns the effects of kSceneAsks that scenes refuse.
[[nodiscard]] inline Ask unbuilt_effects() noexcept {
    return Ask::inside;
}

/// Returns the name of one effect.
[[nodiscard]] inline std::string effect_name(Ask one) {
    const Needs* row = find_needs(one);
    return row == nullptr ? "unknown" : row->name;
}

}  // namespace cdprep::scenes
