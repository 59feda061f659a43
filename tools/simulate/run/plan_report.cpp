// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/run/plan_report.h"

#include <array>
#include <nlohmann/json.hpp>

#include "scene_file/effect_words.h"
#include "simulate/run/effect_counts.h"
#include "simulate/run/section_use.h"
#include "simulate/run/unpaired_layers.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;
using scenes::Change;
using scenes::ChangingObjects;
using scenes::ModelOrigin;
using scenes::SceneFile;
using scenes::SceneModel;

const char* origin_name(ModelOrigin origin) {
    switch (origin) {
        case ModelOrigin::unused:
            return "unused";
        case ModelOrigin::baked:
            return "baked";
        case ModelOrigin::in_memory:
            return "in memory";
        default:
            return "cached";
    }
}

const char* origin_text(ModelOrigin origin) {
    switch (origin) {
        case ModelOrigin::unused:
            return "not opened: no pair of layers uses its objects";
        case ModelOrigin::baked:
            return "a baked file";
        case ModelOrigin::in_memory:
            return "a mesh, baked into memory";
        default:
            return "a mesh, baked into the cache";
    }
}

/// Returns the names of the rows of needs() that a model must serve.
std::vector<std::string> names_of(Ask asks) {
    std::vector<std::string> names;
    for (const Needs& row : needs()) {
        if ((asks & row.ask) != Ask::nothing) names.emplace_back(row.name);
    }
    return names;
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

std::string sections_text(const char* title, const SectionBytes& sections) {
    std::string text = std::string("  ") + title + ": " +
                       counted(sections.rows.size(), "section", "sections") + ", " +
                       counted(sections.bytes, "byte", "bytes");
    for (std::size_t i = 0; i < sections.rows.size(); ++i) {
        text += (i == 0 ? ": " : ", ") + std::string(sections.rows[i].name) + " " +
                std::to_string(sections.rows[i].bytes);
    }
    return text + "\n";
}

std::string model_text(const std::string& path, const SceneModel& model) {
    std::string text = "model " + printable(path) + ": " +
                       counted(model.needs.objects, "object", "objects") + "; " +
                       origin_text(model.origin) + "\n";
    if (!model.model) return text;
    const SectionUse use = use_of(*model.model);
    text += "  must serve: " + joined(names_of(model.needs.asks));
    const Ask wishes = without(model.needs.wishes, model.needs.asks);
    if (wishes != Ask::nothing) text += "; also uses, if present: " + joined(names_of(wishes));
    text += "\n";
    text += sections_text("read", use.read);
    text += sections_text("never touched", use.untouched);
    return text;
}

std::vector<std::uint32_t> objects_by_layer(const SceneFile& scene) {
    std::vector<std::uint32_t> objects(scene.layers.size());
    for (const scenes::FileObject& object : scene.objects) ++objects[object.layer];
    return objects;
}

Json sections_json(const SectionBytes& sections) {
    Json json = Json::array();
    for (const SectionBytes::Row& row : sections.rows) {
        json.push_back({{"name", row.name}, {"bytes", row.bytes}});
    }
    return json;
}

Json model_json(const std::string& path, const SceneModel& model) {
    Json json = {{"path", path},
                 {"objects", model.needs.objects},
                 {"origin", origin_name(model.origin)},
                 {"serves", names_of(model.needs.asks)},
                 {"uses", names_of(without(model.needs.wishes, model.needs.asks))}};
    const SectionUse use = model.model ? use_of(*model.model) : SectionUse{};
    json["read"] = sections_json(use.read);
    json["read_bytes"] = use.read.bytes;
    json["untouched"] = sections_json(use.untouched);
    json["untouched_bytes"] = use.untouched.bytes;
    return json;
}

Json rung_json(const PairRung& rung) {
    Json json = {{"name", rung.rung == Rung::parts ? "parts" : "walk"}, {"error", rung.error}};
    if (rung.rung == Rung::parts) json["parts"] = {rung.parts_a, rung.parts_b};
    return json;
}

Json pair_json(const SceneFile& scene, const Plan& plan, const LayerPair& pair) {
    Json json = {{"layers", {scene.layers[pair.a], scene.layers[pair.b]}},
                 {"effects", names_of(pair.effects)},
                 {"tolerance", pair.tolerance},
                 {"max_distance", pair.max_distance},
                 {"body", pair.body == Body::solid ? "solid" : "surface"},
                 {"overlap", pair.overlap == Overlap::proper ? "proper" : "closed"},
                 {"lists_stays", pair.lists_stays}};
    if (contains(pair.effects, Ask::contacts)) {
        json["contacts"] = {{"tolerance", pair.contacts.tolerance}, {"most", pair.contacts.most}};
        if (pair.contacts.work > 0) json["contacts"]["work"] = pair.contacts.work;
        if (pair.contacts.manifold == Manifold::four) json["contacts"]["manifold"] = true;
        if (pair.contacts.cluster_angle > 0) {
            json["contacts"]["cluster_angle_rad"] = pair.contacts.cluster_angle;
        }
    }
    if (contains(pair.effects, Ask::continuous)) {
        json["impact"] = {{"tolerance", pair.impact.tolerance},
                          {"most_steps", pair.impact.most_steps}};
    }
    if (contains(pair.effects, Ask::haptic)) json["work"] = pair.work;
    if (pair.max_error > 0) {
        json["max_error"] = pair.max_error;
        json["rung"] = rung_json(plan.rungs()[*plan.find_pair(pair.a, pair.b)]);
    }
    return json;
}

/// The objects of layers that respond.
struct RespondingObjects {
    std::uint64_t bodies = 0;
    std::uint64_t driven = 0;
    std::uint64_t fixed = 0;
};

RespondingObjects count_responding(const SceneFile& scene) {
    RespondingObjects counts;
    for (const scenes::FileObject& object : scene.objects) {
        if (!scenes::responds(scene, object.layer)) continue;
        if (object.body != scenes::kNoBody) {
            ++counts.bodies;
        } else if (scene.motions[object.motion].moves()) {
            ++counts.driven;
        } else {
            ++counts.fixed;
        }
    }
    return counts;
}

std::string response_text(const SceneFile& scene) {
    const RespondingObjects counts = count_responding(scene);
    const dynamics::DynamicsOptions options = scenes::dynamics_options_of(scene);
    std::string text = "response: " + counted(counts.bodies, "body", "bodies") + ", " +
                       std::to_string(counts.driven) + " driven, " + std::to_string(counts.fixed) +
                       " fixed; " + counted(options.substeps, "substep", "substeps") +
                       " a frame, " + counted(options.iterations, "iteration", "iterations") +
                       "; contacts within " + in_six_digits(options.tolerance) + "; layers";
    const char* separator = " '";
    for (const scenes::AskedPair& pair : scene.pairs) {
        if (!contains(pair.asked.effects, Ask::response)) continue;
        text += separator + printable(scene.layers[pair.asked.a]) + "' and '" +
                printable(scene.layers[pair.asked.b]) + "'";
        separator = ", '";
    }
    return text + "\n";
}

Json response_json(const SceneFile& scene) {
    const RespondingObjects counts = count_responding(scene);
    const dynamics::DynamicsOptions options = scenes::dynamics_options_of(scene);
    const Double3& g = options.gravity;
    return {{"bodies", counts.bodies},
            {"driven", counts.driven},
            {"fixed", counts.fixed},
            {"substeps", options.substeps},
            {"iterations", options.iterations},
            {"gravity", {g.x, g.y, g.z}},
            {"rest_gap", options.rest_gap},
            {"most_speed", options.most_speed},
            {"tolerance", options.tolerance},
            {"sleep_speed", options.sleep_speed},
            {"most_contacts", options.most_contacts},
            {"sleeps", options.sleeps}};
}

/// Returns the lines of the plan about its pairs of layers. The rest is told here, of all that a
/// simulation computes.
std::string pairs_text(const Plan& plan) {
    const std::string text = plan.describe();
    std::size_t end = 0;
    for (std::size_t i = 0; i < plan.pairs().size(); ++i) end = text.find('\n', end) + 1;
    return text.substr(0, end);
}

/// What the plan leaves out.
std::string not_computed_text(const SceneFile& scene, const Plan& plan) {
    std::string text = not_computed_lines(scene, not_computed(scene, plan));
    std::string alone;
    for (const std::string& name : layers_in_no_pair(scene)) {
        alone += (alone.empty() ? "" : ", ") + printable(name);
    }
    if (!alone.empty())
        text += "layers in no pair, whose objects are never tested: " + alone + "\n";
    return text + unpaired_text(scene);
}

std::string state_text(const Plan& plan) {
    const SceneLimits& limits = plan.limits();
    return "the state of the scene: " + counted(Scene::size(plan), "byte", "bytes") + " for " +
           counted(limits.pairs, "pair", "pairs") + " of boxes and " +
           counted(limits.threads, "thread", "threads") + "\n";
}

Json state_json(const Plan& plan) {
    const SceneLimits& limits = plan.limits();
    return {{"bytes", Scene::size(plan)},
            {"pairs", limits.pairs},
            {"triangle_pairs", limits.triangle_pairs},
            {"contacts", limits.contacts},
            {"threads", limits.threads}};
}

/// Returns the word of the scene file for a deformation, or nothing.
const char* deform_word(const Change& change) {
    constexpr std::array kWords = {"shear", "twist", "stream"};
    return change.deform ? kWords[change.deform->index()] : nullptr;
}

std::string tear_text(const Change& change, const scenes::Cut& cut) {
    if (cut.misses) return "does not tear: the plane misses it";
    return "tears at " + number_text(change.tear->time_s) +
           " s: " + counted(cut.removed.size(), "triangle", "triangles") + " removed and " +
           std::to_string(cut.appended.size()) + " appended, with " +
           counted(cut.vertices.size(), "new vertex", "new vertices");
}

std::string change_text(const SceneFile& scene, const ChangingObjects& changing) {
    const Change& change = scene.changes[changing.change];
    std::string text =
        "live model of object '" + printable(scene.objects[changing.objects.front()].name) + "'";
    if (const std::size_t more = changing.objects.size() - 1; more > 0) {
        text += " and " + std::to_string(more) + " more";
    }
    text += ": ";
    if (change.deform) {
        text += std::string("deforms by a ") + deform_word(change) + (change.tear ? "; " : "");
    }
    if (change.tear) text += tear_text(change, changing.live.cut());
    return text + "; " + counted(changing.live.bytes(), "byte", "bytes") + "\n";
}

Json change_json(const SceneFile& scene, const ChangingObjects& changing) {
    const Change& change = scene.changes[changing.change];
    const scenes::Cut& cut = changing.live.cut();
    Json json = {{"object", scene.objects[changing.objects.front()].name},
                 {"objects", changing.objects.size()},
                 {"model", scene.models[changing.model].string()},
                 {"live_bytes", changing.live.bytes()}};
    if (change.deform) json["deform"] = deform_word(change);
    if (change.tear) {
        json["tear"] = {{"time_s", change.tear->time_s},
                        {"misses", cut.misses},
                        {"torn", cut.removed.size()},
                        {"appended", cut.appended.size()},
                        {"vertices", cut.vertices.size()}};
    }
    return json;
}

}  // namespace

std::string plan_text(const SceneFile& scene, const Plan& plan, std::span<const SceneModel> models,
                      std::span<const ChangingObjects> changing) {
    std::string text = printable(scene.name) + ": " +
                       counted(scene.objects.size(), "object", "objects") + ", " +
                       counted(models.size(), "model", "models") + ", " +
                       counted(scene.layers.size(), "layer", "layers") + "\n";
    const std::vector<std::uint32_t> objects = objects_by_layer(scene);
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        text += "layer '" + printable(scene.layers[i]) +
                "': " + counted(objects[i], "object", "objects") + "\n";
    }
    text += pairs_text(plan);
    if (scenes::has_response(scene)) text += response_text(scene);
    text += not_computed_text(scene, plan) + state_text(plan);
    for (std::size_t i = 0; i < models.size(); ++i) {
        text += model_text(scene.models[i].string(), models[i]);
    }
    for (const ChangingObjects& one : changing) text += change_text(scene, one);
    return text;
}

std::string plan_json(const SceneFile& scene, const Plan& plan, std::span<const SceneModel> models,
                      std::span<const ChangingObjects> changing) {
    Json json = {{"scene", scene.name}, {"version", CDPREP_VERSION}, {"exit", 0}};
    const std::vector<std::uint32_t> objects = objects_by_layer(scene);
    json["layers"] = Json::array();
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        json["layers"].push_back({{"name", scene.layers[i]}, {"objects", objects[i]}});
    }
    json["pairs"] = Json::array();
    for (const scenes::AskedPair& pair : scene.pairs) {
        if (pair.asked.effects == Ask::nothing) continue;
        json["pairs"].push_back(pair_json(scene, plan, pair.asked));
    }
    if (scenes::has_response(scene)) json["response"] = response_json(scene);
    json["not_computed"] = not_computed(scene, plan);
    json["not_built"] = not_built();
    json["layers_in_no_pair"] = layers_in_no_pair(scene);
    json["unpaired"] = unpaired_json(scene);
    json["state"] = state_json(plan);
    json["models"] = Json::array();
    for (std::size_t i = 0; i < models.size(); ++i) {
        json["models"].push_back(model_json(scene.models[i].string(), models[i]));
    }
    if (!changing.empty()) {
        json["changes"] = Json::array();
        for (const ChangingObjects& one : changing) {
            json["changes"].push_back(change_json(scene, one));
        }
    }
    json["refusals"] = Json::array();
    return laid_out(json, 0) + "\n";
}

std::string refused_json(const std::string& scene, int exit,
                         const std::vector<std::string>& refusals) {
    return laid_out(Json{{"scene", scene},
                         {"version", CDPREP_VERSION},
                         {"exit", exit},
                         {"refusals", refusals}},
                    0) +
           "\n";
}

}  // namespace cdprep::report
