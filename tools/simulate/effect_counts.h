// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "cdprep/scene.h"
#include "scene_file/effect_words.h"
#include "simulate/response.h"

namespace cdprep::report {

/// Returns the place of an effect in kSceneEffects.
[[nodiscard]] inline std::size_t effect_number(Ask effect) noexcept {
    const auto* at = std::find(kSceneEffects.begin(), kSceneEffects.end(), effect);
    return static_cast<std::size_t>(at - kSceneEffects.begin());
}

/// Returns the ticks from the first query of a step to the end of the last that no query took.
[[nodiscard]] inline std::uint64_t rest_of_pairs(const SceneCounts& counts,
                                                 std::size_t threads) noexcept {
    std::uint64_t queries = 0;
    for (const std::uint64_t ticks : counts.ticks) queries += ticks;
    queries /= threads;
    return counts.query_ticks - std::min(counts.query_ticks, queries);
}

/// Returns the names of the effects that a scene could compute, but no pair of layers asks for.
[[nodiscard]] inline std::vector<std::string> not_computed(const scenes::SceneFile& scene,
                                                           const Plan& plan) {
    std::vector<std::string> names;
    for (const Ask effect : kSceneEffects) {
        if (!contains(plan.effects(), effect)) names.push_back(scenes::effect_name(effect));
    }
    if (!scenes::has_response(scene)) names.push_back(scenes::effect_name(Ask::response));
    return names;
}

}  // namespace cdprep::report
