// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cdprep/scene.h"
#include "scene_file/effect_words.h"
#include "simulate/run/response.h"
#include "simulate/run/simulation.h"

namespace cdprep::report {

/// The effects of a simulation: those of the library's scene, then `response`.
inline constexpr auto kSimulatedEffects = [] {
    std::array<Ask, kSceneEffects.size() + 1> all{};
    std::copy(kSceneEffects.begin(), kSceneEffects.end(), all.begin());
    all.back() = Ask::response;
    return all;
}();

/// How the time of a scene changes without one of its effects.
struct EffectCost {
    Ask effect;
    double change;  ///< of the time of all frames: -0.25 for a quarter less; median of the rounds
    double spread;  ///< the largest change of a round minus the smallest
};

/// Returns the effects that some pair of layers asks for.
[[nodiscard]] inline Ask asked_effects(const scenes::SceneFile& scene, const Plan& plan) {
    return plan.effects() | (scenes::has_response(scene) ? Ask::response : Ask::nothing);
}

/// Returns the effects that a simulation computes. A replay computes no `response`.
[[nodiscard]] inline Ask computed_effects(const scenes::Simulation& simulation) {
    return simulation.plan().effects() |
           (simulation.response() != nullptr ? Ask::response : Ask::nothing);
}

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

/// Returns the names of the effects that no version computes yet.
[[nodiscard]] inline std::vector<std::string> not_built() {
    std::vector<std::string> names;
    for (const std::string& word : scenes::effect_words()) {
        if (contains(scenes::unbuilt_effects(), scenes::effect_of(word))) names.push_back(word);
    }
    return names;
}

/// Returns the names of the effects that no pair of layers asks for, or not any more.
[[nodiscard]] inline std::vector<std::string> not_computed(const scenes::SceneFile& scene,
                                                           const Plan& plan) {
    std::vector<std::string> names;
    const Ask asked = asked_effects(scene, plan);
    for (const Ask effect : kSimulatedEffects) {
        if (!contains(asked, effect)) names.push_back(scenes::effect_name(effect));
    }
    return names;
}

/// Returns them as lines of text: those that no pair requests, and those that --drop left out. Then
/// come those that no version computes yet.
[[nodiscard]] inline std::string not_computed_lines(const scenes::SceneFile& scene,
                                                    std::span<const std::string> names) {
    std::string unasked, dropped, unbuilt;
    const auto add = [](std::string& list, const std::string& name) {
        list += (list.empty() ? "" : ", ") + name;
    };
    for (const std::string& name : names) {
        const bool is_dropped = contains(scene.dropped, scenes::effect_of(name));
        add(is_dropped ? dropped : unasked, name);
    }
    for (const std::string& name : not_built()) add(unbuilt, name);
    std::string text;
    if (!unasked.empty()) text += "not requested by any pair of layers: " + unasked + "\n";
    if (!dropped.empty()) text += "left out by --drop: " + dropped + "\n";
    return text + "not supported yet: " + unbuilt + "\n";
}

}  // namespace cdprep::report
