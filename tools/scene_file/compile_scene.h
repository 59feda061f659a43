// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene_file/scene_file.h"

namespace cdprep::scenes {

/// The effects that the objects of a model need.
struct ModelNeeds {
    Ask asks = Ask::nothing;                    ///< nothing: no object of the model is tested
    Ask wishes = Ask::nothing;                  ///< what is used if the model serves it
    std::uint32_t layers = 0;                   ///< of its objects: bit i for layer i
    std::uint32_t objects = 0;                  ///< all, also in layers without a pair
    std::array<Ask, kLayers> asks_of_layers{};  ///< `asks` of its objects in each layer

    [[nodiscard]] Ask wanted() const noexcept {
        return asks | wishes;
    }
};

/// What the objects of each layer are asked for.
using LayerAsks = std::array<Ask, kLayers>;

/// Returns what a plan asks for.
[[nodiscard]] LayerAsks asks_of_layers(const Plan& plan);
/// Returns the same of a scene without a plan. A pair of layers that a plan refuses asks for
/// nothing.
[[nodiscard]] LayerAsks asks_of_layers(const SceneFile& scene);

/// Returns what each model of a scene must serve. The model of an object that deforms or tears must
/// serve as the base of a live model.
[[nodiscard]] std::vector<ModelNeeds> needs_of_models(const SceneFile& scene,
                                                      const LayerAsks& asks);

/// Returns whether a pair of layers asks for the object. Others are not added to a scene.
[[nodiscard]] bool is_asked(const SceneFile& scene, const Plan& plan, const FileObject& object);

/// Returns what a pair asks of the library's scene: all but `response`, which moves bodies.
[[nodiscard]] inline Ask scene_effects(const AskedPair& pair) noexcept {
    return without(pair.asked.effects, Ask::response);
}

/// Returns whether a pair of layers asks that objects of a layer push others.
[[nodiscard]] bool responds(const SceneFile& scene, std::uint32_t layer);

/// Compiles the plan of a scene file, without `response`, which the library does not compute. Every
/// refusal begins with the name of the file, and names the line of a pair. Whether models serve
/// their layers is checked by model_refusals(). Also refuses objects that deform or tear unless
/// each pair of their layer asks for it. Refuses bodies that nothing can push, and `response` of
/// layers in which nothing is a body. The parts of `models` decide the rungs of pairs with a
/// max_error.
[[nodiscard]] Plan::Compiled compile_scene(const SceneFile& scene, const SceneLimits& limits,
                                           std::span<const ModelUse> models = {});

/// Drops an effect from all pairs of layers, and the options that no effect reads then. Without
/// `response`, bodies stay where they are.
void drop_effect(SceneFile& scene, Ask effect);

}  // namespace cdprep::scenes
