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
Ask needs_of(const SceneFile& scene, const FileObject& object, Ask asks) {
    if (object.change == kUnchanged || asks == Ask::nothing) return asks;
    const Ask live = scene.changes[object.change].tear ? Ask::tear : Ask::deform;
    return live | (asks & Ask::solid);
}

/// Returns why objects cannot change as their motions say. There is a sentence for each pair of
/// layers that does not ask for it, about its first object. The plan checks the other pairs.
std::vector<std::string> change_refusals(const SceneFile& scene) {
    std::vector<std::string> refusals;
    std::set<std::pair<std::size_t, Ask>> seen;
    for (const FileObject& object : scene.objects) {
        if (object.change == kUnchanged) continue;
        const bool tears = scene.changes[object.change].tear.has_value();
        const Ask wanted = tears ? Ask::tear : Ask::deform | Ask::tear;
        for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
            const LayerPair& pair = scene.pairs[i].asked;
            if (pair.a != object.layer && pair.b != object.layer) continue;
            if (pair.effects == Ask::nothing || (pair.effects & wanted) != Ask::nothing) continue;
            if (!seen.insert({i, wanted}).second) continue;
            const auto layer = [&](std::uint32_t number) {
                return "'" + report::printable(scene.layers[number]) + "'";
            };
            refusals.push_back("Object '" + report::printable(object.name) + "' in layer " +
                               layer(object.layer) + (tears ? " tears" : " deforms") + ". Add " +
                               (tears ? "tear" : "deform") + " to the effects of pair " +
                               std::to_string(i) + " of layers, " + layer(pair.a) + " and " +
                               layer(pair.b) + ".");
        }
    }
    return refusals;
}

}  // namespace

std::vector<ModelNeeds> needs_of_models(const SceneFile& scene, const Plan& plan) {
    std::vector<ModelNeeds> needs(scene.models.size());
    for (const FileObject& object : scene.objects) {
        ModelNeeds& model = needs[object.model];
        model.asks = model.asks | needs_of(scene, object, plan.asks_of(object.layer));
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
    for (std::string& refusal : change_refusals(scene)) {
        compiled.refusals.push_back(std::move(refusal));
    }
    if (!compiled.refusals.empty()) compiled.plan.reset();
    for (std::string& refusal : compiled.refusals) refusal.insert(0, scene.name + ": ");
    return compiled;
}

void drop_effect(SceneFile& scene, Ask effect) {
    const LayerPair unused;
    for (AskedPair& pair : scene.pairs) {
        LayerPair& asked = pair.asked;
        asked.effects = without(asked.effects, effect);
        const auto is_read_by = [&](Ask readers) {
            return (asked.effects & readers) != Ask::nothing;
        };
        if (!is_read_by(Ask::within)) asked.tolerance = unused.tolerance;
        if (!is_read_by(Ask::distance | Ask::haptic)) asked.max_distance = unused.max_distance;
        if (!is_read_by(Ask::continuous)) asked.impact = unused.impact;
        if (!is_read_by(Ask::haptic)) asked.work = unused.work;
        if (!is_read_by(Ask::collide | Ask::overlap)) asked.overlap = unused.overlap;
        if (!is_read_by(Ask::contacts)) asked.contacts = unused.contacts;
        if (!is_read_by(Ask::collide | Ask::distance | Ask::contacts | Ask::continuous)) {
            asked.body = unused.body;
        }
    }
}

}  // namespace cdprep::scenes
