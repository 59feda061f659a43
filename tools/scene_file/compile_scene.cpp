// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/compile_scene.h"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "scene_file/effect_words.h"
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

/// Returns what the model of an object must serve so that it can push others. `has_continuous`
/// tells whether any body is.
ModelNeeds needs_of_response(const SceneFile& scene, const FileObject& object,
                             bool has_continuous) {
    ModelNeeds needs{.asks = Ask::contacts, .wishes = Ask::solid};
    if (has_continuous) needs.asks = needs.asks | Ask::distance;
    if (object.body == kNoBody) return needs;
    // With a given mass, the file still tells how it is distributed.
    Ask& mass = scene.bodies[object.body].mass ? needs.wishes : needs.asks;
    mass = mass | Ask::response;
    return needs;
}

std::string quoted(const std::string& name) {
    return "'" + report::printable(name) + "'";
}

std::string words_for(const SceneFile& scene, std::size_t pair) {
    const LayerPair& asked = scene.pairs[pair].asked;
    return "Pair " + std::to_string(pair) + " of layers, " + quoted(scene.layers[asked.a]) +
           " and " + quoted(scene.layers[asked.b]);
}

/// Returns " (line 12)", the place of a pair.
std::string line_text(const SceneFile& scene, std::size_t pair) {
    const std::size_t line = scene.pairs[pair].line;
    return line == 0 ? "" : " (line " + std::to_string(line) + ")";
}

/// Returns the start of a refusal: the file and, if it is about a pair, its place there.
std::string place_of(const SceneFile& scene, const std::string& refusal) {
    for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
        if (scene.pairs[i].line == 0 || !refusal.starts_with(words_for(scene, i) + ":")) continue;
        return scene.name + ": line " + std::to_string(scene.pairs[i].line) + ": /pairs/" +
               std::to_string(i) + ": ";
    }
    return scene.name + ": ";
}

/// Returns why effects are not computed.
std::vector<std::string> effect_refusals(const SceneFile& scene) {
    std::string built;
    for (const std::string& word : effect_words()) {
        if (contains(unbuilt_effects(), effect_of(word))) continue;
        built += (built.empty() ? "" : ", ") + word;
    }
    std::vector<std::string> refusals;
    for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
        for (const std::string& word : effect_words()) {
            const Ask effect = effect_of(word);
            if (!contains(scene.pairs[i].asked.effects & unbuilt_effects(), effect)) continue;
            std::string refusal = words_for(scene, i) + ": " + word;
            refusal += " is not supported in a scene. Choose from ";
            refusals.push_back(std::move(refusal) + built + ".");
        }
    }
    return refusals;
}

/// Drops effects from a pair of layers, and the options that no effect reads then.
void drop_effects(LayerPair& pair, Ask effects) {
    const LayerPair unused;
    pair.effects = without(pair.effects, effects);
    const auto is_read_by = [&](Ask readers) { return (pair.effects & readers) != Ask::nothing; };
    if (!is_read_by(Ask::within)) pair.tolerance = unused.tolerance;
    if (!is_read_by(Ask::distance | Ask::haptic)) pair.max_distance = unused.max_distance;
    if (!is_read_by(Ask::distance)) pair.max_error = unused.max_error;
    if (!is_read_by(Ask::continuous)) pair.impact = unused.impact;
    if (!is_read_by(Ask::haptic)) pair.work = unused.work;
    if (!is_read_by(Ask::collide | Ask::overlap)) pair.overlap = unused.overlap;
    if (!is_read_by(Ask::contacts)) pair.contacts = unused.contacts;
    if (!is_read_by(Ask::collide | Ask::distance | Ask::contacts | Ask::continuous)) {
        pair.body = unused.body;
    }
}

/// Returns the pairs of layers as the library gets them: without `response`, and without effects
/// that are not built.
std::vector<LayerPair> library_pairs(const SceneFile& scene) {
    std::vector<LayerPair> pairs;
    for (const AskedPair& pair : scene.pairs) {
        pairs.push_back(pair.asked);
        LayerPair& asked = pairs.back();
        asked.effects = scene_effects(pair);
        const Ask unbuilt = asked.effects & unbuilt_effects();
        if (unbuilt != Ask::nothing) drop_effects(asked, unbuilt);
    }
    return pairs;
}

/// Models are not open yet, so the first object's translation stands for all objects.
Double3 origin_of(const SceneFile& scene) {
    if (scene.objects.empty()) return {};
    const auto pose = pose_of(scene, scene.objects[0], 0);
    return pose ? pose->translation() : Double3{};
}

/// Returns why objects of responding layers cannot push each other. There is a sentence for the
/// first such object of a layer, and one for each pair of layers without a body.
std::vector<std::string> body_refusals(const SceneFile& scene) {
    std::vector<std::string> refusals;
    std::set<std::pair<std::uint32_t, bool>> seen;
    std::set<std::uint32_t> with_bodies;
    for (const FileObject& object : scene.objects) {
        const bool is_body = object.body != kNoBody;
        if (is_body) with_bodies.insert(object.layer);
        const bool moves_alone = is_body && !responds(scene, object.layer);
        const bool changes = object.change != kUnchanged && responds(scene, object.layer);
        if (!moves_alone && !changes) continue;
        if (!seen.insert({object.layer, changes}).second) continue;
        const std::string start =
            "Object " + quoted(object.name) + " in layer " + quoted(scene.layers[object.layer]);
        refusals.push_back(moves_alone
                               ? start + " is a body, but no pair of this layer requests response."
                               : start +
                                     " deforms or tears. The response of such models is not "
                                     "supported: pieces do not follow the surface.");
    }
    for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
        const LayerPair& pair = scene.pairs[i].asked;
        if (!contains(pair.effects, Ask::response)) continue;
        if (with_bodies.contains(pair.a) || with_bodies.contains(pair.b)) continue;
        refusals.push_back(words_for(scene, i) +
                           ": response needs bodies, but no object of these layers has the motion "
                           "\"body\".");
    }
    return refusals;
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
            refusals.push_back("Object " + quoted(object.name) + " in layer " +
                               quoted(scene.layers[object.layer]) +
                               (tears ? " tears" : " deforms") + ". Add " +
                               (tears ? "tear" : "deform") + " to the effects of pair " +
                               std::to_string(i) + " of layers, " + quoted(scene.layers[pair.a]) +
                               " and " + quoted(scene.layers[pair.b]) + line_text(scene, i) + ".");
        }
    }
    return refusals;
}

}  // namespace

LayerAsks asks_of_layers(const Plan& plan) {
    LayerAsks asks{};
    for (std::uint32_t layer = 0; layer < kLayers; ++layer) asks[layer] = plan.asks_of(layer);
    return asks;
}

LayerAsks asks_of_layers(const SceneFile& scene) {
    LayerAsks asks{};
    for (const LayerPair& pair : library_pairs(scene)) {
        const Plan::Compiled alone =
            Plan::compile({.pairs = {&pair, 1}, .limits = {}, .origin = origin_of(scene)});
        if (!alone.plan) continue;
        for (const std::uint32_t layer : {pair.a, pair.b}) {
            asks[layer] = asks[layer] | alone.plan->asks_of(layer);
        }
    }
    return asks;
}

std::vector<ModelNeeds> needs_of_models(const SceneFile& scene, const LayerAsks& layer_asks) {
    std::vector<ModelNeeds> needs(scene.models.size());
    const bool has_continuous = std::ranges::any_of(scene.bodies, &BodyMotion::is_continuous);
    for (const FileObject& object : scene.objects) {
        ModelNeeds& model = needs[object.model];
        Ask asks = needs_of(scene, object, layer_asks[object.layer]);
        if (responds(scene, object.layer)) {
            const ModelNeeds more = needs_of_response(scene, object, has_continuous);
            asks = asks | more.asks;
            model.wishes = model.wishes | more.wishes;
        }
        Ask& of_layer = model.asks_of_layers[object.layer];
        of_layer = of_layer | asks;
        model.asks = model.asks | asks;
        model.layers |= 1U << object.layer;
        ++model.objects;
    }
    return needs;
}

bool is_asked(const SceneFile& scene, const Plan& plan, const FileObject& object) {
    return plan.asks_of(object.layer) != Ask::nothing || responds(scene, object.layer);
}

bool responds(const SceneFile& scene, std::uint32_t layer) {
    return std::ranges::any_of(scene.pairs, [&](const AskedPair& pair) {
        const bool has_layer = pair.asked.a == layer || pair.asked.b == layer;
        return has_layer && contains(pair.asked.effects, Ask::response);
    });
}

Plan::Compiled compile_scene(const SceneFile& scene, const SceneLimits& limits,
                             std::span<const ModelUse> models) {
    const std::vector<LayerPair> pairs = library_pairs(scene);
    std::vector<std::string> names;
    for (const std::string& layer : scene.layers) names.push_back(report::printable(layer));
    const std::vector<std::string_view> layers(names.begin(), names.end());
    Plan::Compiled compiled = Plan::compile({.pairs = pairs,
                                             .models = models,
                                             .limits = limits,
                                             .origin = origin_of(scene),
                                             .layer_names = layers});
    for (auto* find_refusals : {effect_refusals, change_refusals, body_refusals}) {
        for (std::string& refusal : find_refusals(scene)) {
            compiled.refusals.push_back(std::move(refusal));
        }
    }
    if (!compiled.refusals.empty()) compiled.plan.reset();
    for (std::string& refusal : compiled.refusals) {
        refusal.insert(0, place_of(scene, refusal));
    }
    return compiled;
}

void drop_effect(SceneFile& scene, Ask effect) {
    if (effect == Ask::response) {
        for (FileObject& object : scene.objects) object.body = kNoBody;
    }
    for (AskedPair& pair : scene.pairs) {
        if (contains(pair.asked.effects, effect)) scene.dropped = scene.dropped | effect;
        drop_effects(pair.asked, effect);
    }
}

}  // namespace cdprep::scenes
