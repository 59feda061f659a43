// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/compile_scene.h"

#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "text/printable.h"

namespace cdprep::scenes {
namespace {

/// Returns what the model of an object must serve for the queries of its layer. A model that
/// changes is the base of a live model, which answers them.
Ask needs_of(const FileObject& object, Ask asks) {
    if (object.change == kUnchanged || asks == Ask::nothing) return asks;
    return Ask::overlap | Ask::corners | (asks & Ask::solid);
}

/// Returns "deforms", "tears" or "deforms and tears".
std::string verb_of(const Change& change) {
    if (!change.tear) return "deforms";
    return change.deform ? "deforms and tears" : "tears";
}

/// Returns why objects cannot change as their motions say: a sentence for the first object of each
/// layer and change.
std::vector<std::string> change_refusals(const SceneFile& scene, const Plan& plan) {
    std::vector<std::string> refusals;
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (const FileObject& object : scene.objects) {
        if (object.change == kUnchanged || !is_asked(plan, object)) continue;
        if (!seen.insert({object.layer, object.change}).second) continue;
        if (!contains(plan.asks_of(object.layer), Ask::contacts)) continue;
        refusals.push_back("Object '" + report::printable(object.name) + "' " +
                           verb_of(scene.changes[object.change]) + ", and its layer '" +
                           report::printable(scene.layers[object.layer]) +
                           "' asks for contacts, which a live model does not serve. Ask for "
                           "overlap or within instead.");
    }
    return refusals;
}

}  // namespace

std::vector<ModelNeeds> needs_of_models(const SceneFile& scene, const Plan& plan) {
    std::vector<ModelNeeds> needs(scene.models.size());
    for (const FileObject& object : scene.objects) {
        ModelNeeds& model = needs[object.model];
        model.asks = model.asks | needs_of(object, plan.asks_of(object.layer));
        model.layers |= 1U << object.layer;
        ++model.objects;
    }
    return needs;
}

bool is_asked(const Plan& plan, const FileObject& object) noexcept {
    return plan.asks_of(object.layer) != Ask::nothing;
}

Plan::Compiled compile_scene(const SceneFile& scene, const SceneLimits& limits,
                             std::span<const ModelUse> models) {
    std::vector<LayerPair> pairs;
    for (const AskedPair& pair : scene.pairs) pairs.push_back(pair.asked);
    std::vector<std::string> names;
    for (const std::string& layer : scene.layers) names.push_back(report::printable(layer));
    const std::vector<std::string_view> layers(names.begin(), names.end());
    // Models are not open yet, so the first object's translation stands for all objects.
    Double3 origin{};
    if (!scene.objects.empty()) {
        if (const auto pose = pose_of(scene, scene.objects[0], 0)) origin = pose->translation();
    }
    Plan::Compiled compiled = Plan::compile({.pairs = pairs,
                                             .models = models,
                                             .limits = limits,
                                             .origin = origin,
                                             .layer_names = layers});
    for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
        const LayerPair& pair = pairs[i];
        for (const std::string& effect : scene.pairs[i].unbuilt) {
            compiled.refusals.push_back("Pair " + std::to_string(i) + " of layers, '" +
                                        names[pair.a] + "' and '" + names[pair.b] +
                                        "': " + unbuilt_effect(effect));
        }
    }
    if (compiled.plan) {
        for (std::string& refusal : change_refusals(scene, *compiled.plan)) {
            compiled.refusals.push_back(std::move(refusal));
        }
    }
    if (!compiled.refusals.empty()) compiled.plan.reset();
    for (std::string& refusal : compiled.refusals) refusal.insert(0, scene.name + ": ");
    return compiled;
}

}  // namespace cdprep::scenes
