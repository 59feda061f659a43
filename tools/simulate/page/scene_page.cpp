// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/page/scene_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "page/base64.h"
#include "page/page_parts.h"
#include "page/page_text.h"
#include "simulate/page/scene_chart.h"
#include "simulate/page/scene_geometry.h"
#include "simulate/run/effect_counts.h"
#include "simulate/run/plan_report.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace page {

extern const std::string_view kSceneFrame;  ///< scene_page.html, with places for the rest
extern const std::string_view kSceneStyle;  ///< scene_page.css
extern const std::string_view kSceneData;   ///< scene_data.js
extern const std::string_view kSceneView;   ///< scene_view.js
extern const std::string_view kSceneLanes;  ///< scene_lanes.js
extern const std::string_view kScenePage;   ///< scene_page.js

}  // namespace page
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kJsonType = "application/json";

template <class T>
std::string packed(const std::vector<T>& values) {
    return base64(std::as_bytes(std::span(values)));
}

Json point_json(const Double3& p) {
    return {p.x, p.y, p.z};
}

double microseconds(double seconds) {
    return std::round(1e7 * seconds) / 10;
}

void append(std::vector<float>& floats, const std::array<float, 3>& point) {
    floats.insert(floats.end(), point.begin(), point.end());
}

/// Writes the shown frames in page units.
class FrameWriter {
public:
    FrameWriter(const scenes::SceneFile& file, const SceneGeometry& geometry)
        : file_(file), geometry_(geometry) {}

    [[nodiscard]] Json json(const ShownFrame& shown) const {
        Json json = {{"frame", shown.frame}, {"us", microseconds(shown.seconds)}};
        add_poses(json, shown.moved);
        json["lit"] = Json::array();
        for (const LitTriangles& one : shown.lit) {
            json["lit"].push_back({one.object, packed(one.triangles)});
        }
        add_results(json, shown);
        add_shapes(json, shown);
        const SceneCounts& counts = shown.counts;
        json["counts"] = {{"moved", counts.moved},
                          {"candidates", counts.candidates},
                          {"kept", counts.kept},
                          {"apart", counts.apart},
                          {"triangle_pairs", counts.triangle_pairs},
                          {"contacts", counts.contacts},
                          {"unknown", shown.pairs_unknown}};
        json["calls"] = counts.calls;
        json["calls"].push_back(shown.bodies ? shown.bodies->calls : 0);
        if (shown.bodies) json["awake"] = shown.bodies->awake;
        return json;
    }

private:
    void add_poses(Json& json, const std::vector<ObjectPose>& moved) const {
        std::vector<std::uint32_t> objects;
        std::vector<float> poses;
        for (const ObjectPose& one : moved) {
            objects.push_back(one.object);
            for (const double x : quaternion_of(one.pose.rotation())) {
                poses.push_back(static_cast<float>(x));
            }
            const std::uint32_t model = file_.objects[one.object].model;
            append(poses, geometry_.frame.from_model(
                              transform_point(one.pose, geometry_.models[model].centre)));
        }
        json["moved"] = packed(objects);
        json["poses"] = packed(poses);
    }

    void add_results(Json& json, const ShownFrame& shown) const {
        std::vector<std::uint32_t> hits;
        for (const ShownHit& hit : shown.hits) {
            hits.insert(hits.end(), {hit.a, hit.b, hit.effects});
        }
        json["hits"] = packed(hits);
        std::vector<std::uint32_t> contact_objects;
        std::vector<float> contacts;
        for (const ShownContact& contact : shown.contacts) {
            contact_objects.insert(contact_objects.end(), {contact.a, contact.b});
            append(contacts, geometry_.frame.from_model(contact.point));
            append(contacts, float_point(contact.normal));
            add_bounds(contacts, contact.lower, contact.upper);
        }
        json["contact_objects"] = packed(contact_objects);
        json["contacts"] = packed(contacts);
        std::vector<std::uint32_t> distance_objects;
        std::vector<float> distances;
        for (const ShownDistance& distance : shown.distances) {
            distance_objects.insert(distance_objects.end(), {distance.a, distance.b});
            append(distances, geometry_.frame.from_model(distance.from));
            append(distances, geometry_.frame.from_model(distance.to));
            add_bounds(distances, distance.lower, distance.upper);
        }
        json["distance_objects"] = packed(distance_objects);
        json["distances"] = packed(distances);
    }

    /// Positions are in page units, from the centre of the model.
    void add_shapes(Json& json, const ShownFrame& shown) const {
        json["shapes"] = Json::array();
        for (const ShownShape& shape : shown.shapes) {
            std::vector<float> positions = shape.positions;
            for (float& x : positions) x = std::ldexp(x, -geometry_.frame.exponent);
            json["shapes"].push_back({shape.changing, shape.is_torn ? 1 : 0, packed(positions)});
        }
    }

    static std::array<float, 3> float_point(const Double3& p) {
        return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    static void add_bounds(std::vector<float>& floats, double lower, double upper) {
        floats.push_back(static_cast<float>(lower));
        floats.push_back(static_cast<float>(upper));
    }

    const scenes::SceneFile& file_;
    const SceneGeometry& geometry_;
};

bool has_y_up(const scenes::SceneFile& file) {
    const Double3 gravity = file.dynamics.gravity.value_or(Double3{});
    const double y = std::abs(gravity.y), z = std::abs(gravity.z);
    return y == z ? file.y_is_up : y > z;
}

const char* state_of(const ModelDrawing& model) {
    if (!model.is_drawn) return "none";
    return model.is_exact ? "exact" : "coarse";
}

Json models_json(const scenes::SceneFile& file, const SceneGeometry& geometry) {
    Json json = Json::array();
    for (std::size_t i = 0; i < geometry.models.size(); ++i) {
        const ModelDrawing& model = geometry.models[i];
        json.push_back({{"path", file.models[i].string()},
                        {"name", file.models[i].filename().string()},
                        {"triangles", model.triangles},
                        {"drawn", state_of(model)},
                        {"half", model.half}});
    }
    return json;
}

Json triangles_json(const ModelDrawing& model) {
    if (!model.is_drawn) return nullptr;
    Json json = {{"positions", packed(model.drawn.positions)},
                 {"indices", packed(model.drawn.indices)}};
    bool is_in_order = true;
    for (std::uint32_t i = 0; i < model.numbers.size(); ++i) is_in_order &= model.numbers[i] == i;
    if (!model.is_exact || !is_in_order) json["numbers"] = packed(model.numbers);
    if (!model.is_exact) json["lit"] = packed(model.lit);
    return json;
}

Json objects_json(const scenes::SceneFile& file, const Plan& plan, std::uint32_t count) {
    Json json = Json::array();
    for (std::uint32_t i = 0; i < count; ++i) {
        const scenes::FileObject& object = file.objects[i];
        json.push_back(
            {object.name, object.model, object.layer, is_asked(file, plan, object) ? 1 : 0});
    }
    return json;
}

/// The live models and their objects; null for one that is drawn at rest.
Json changing_json(const SceneFrames& frames, std::span<const scenes::ChangingObjects> changing) {
    Json json = Json::array();
    for (std::size_t i = 0; i < changing.size(); ++i) {
        const ShownLiveModel& live = frames.live_models()[i];
        if (!live.is_drawn) {
            json.push_back(nullptr);
            continue;
        }
        Json topologies = Json::array();
        for (const ShownTopology& topology : live.topologies) {
            topologies.push_back(
                {{"indices", packed(topology.indices)}, {"numbers", packed(topology.numbers)}});
        }
        std::vector<std::uint32_t> objects = changing[i].objects;
        std::erase_if(objects, [&](std::uint32_t object) { return object >= frames.objects(); });
        json.push_back({{"objects", objects}, {"topologies", topologies}});
    }
    return json;
}

/// `asked` are those of the scene file, `dropped` those that it asked for before, and `computed`
/// those of the run.
Json effects_json(Ask asked, Ask dropped, Ask computed, std::span<const EffectCost> costs) {
    Json json = Json::array();
    for (const Ask effect : kSimulatedEffects) {
        json.push_back({{"name", scenes::effect_name(effect)},
                        {"asked", contains(computed, effect)},
                        {"is_dropped", contains(dropped, effect)},
                        {"is_replayed", contains(asked, effect) && !contains(computed, effect)}});
        const auto cost = std::ranges::find(costs, effect, &EffectCost::effect);
        if (cost == costs.end()) continue;
        json.back()["change_of_time"] = cost->change;
        json.back()["spread_of_time"] = cost->spread;
    }
    return json;
}

Json spans_json(const SceneTimeline& timeline) {
    Json frames = Json::array();
    Json begins = Json::array();
    Json ends = Json::array();
    Json holds = Json::array();
    Json us = Json::array();
    Json longest = Json::array();
    for (const TimelineSpan& span : timeline.spans()) {
        frames.push_back(span.frames);
        begins.push_back(span.begins);
        ends.push_back(span.ends);
        holds.push_back(span.holds);
        Json stages = Json::array();
        for (const double seconds : span.seconds) {
            stages.push_back(microseconds(seconds / static_cast<double>(span.frames)));
        }
        us.push_back(std::move(stages));
        longest.push_back(microseconds(span.longest));
    }
    return {{"stages", timeline.stages()},
            {"frames", frames},
            {"begins", begins},
            {"ends", ends},
            {"holds", holds},
            {"us", us},
            {"longest", longest}};
}

std::string sentence(std::uint64_t count, const char* one, const char* many, const char* rest) {
    return counted(count, one, many) + " " + rest;
}

/// Words what the limits of the page left out.
class LeftOut {
public:
    std::vector<std::string> sentences;

    void add_frames(const SceneFrames& frames, std::uint64_t count, std::size_t objects) {
        if (frames.stride() > 1) {
            add("The page shows every " + std::to_string(frames.stride()) + "th of " +
                std::to_string(count) + " frames, and the last one. The lanes count all frames.");
        }
        if (objects > frames.objects()) {
            add("The page has " + std::to_string(frames.objects()) + " of " +
                std::to_string(objects) + " objects: the first ones in the file.");
        }
        ShownFrame sum;
        for (const ShownFrame& shown : frames.frames()) {
            sum.lit_left_out += shown.lit_left_out;
            sum.hits_left_out += shown.hits_left_out;
            sum.contacts_left_out += shown.contacts_left_out;
            sum.distances_left_out += shown.distances_left_out;
        }
        add_parts(sum.lit_left_out, "touching triangle", "touching triangles");
        add_parts(sum.hits_left_out, "pair of objects", "pairs of objects");
        add_parts(sum.contacts_left_out, "contact", "contacts");
        add_parts(sum.distances_left_out, "distance", "distances");
    }

    void add_models(const scenes::SceneFile& file, const SceneGeometry& geometry,
                    std::span<const scenes::SceneModel> models) {
        for (std::size_t i = 0; i < geometry.models.size(); ++i) {
            const ModelDrawing& model = geometry.models[i];
            const std::string name = printable(file.models[i].filename().string());
            if (!model.is_drawn && models[i].needs.asks == Ask::nothing) {
                add(name +
                    " is not drawn: no pair of layers uses its objects, so it was not opened.");
            } else if (!model.is_drawn && models[i].model && model.triangles > 0) {
                add(name +
                    " is not drawn: it has no positions, or the page has no object that uses it.");
            } else if (!model.is_exact) {
                add(name + " is drawn coarsely because it has " + std::to_string(model.triangles) +
                    " triangles. Its touching triangles are exact.");
            }
            if (model.lit_left_out > 0) {
                add(sentence(model.lit_left_out, "triangle", "triangles", "of ") + name +
                    " touch in some frame, but are not drawn.");
            }
        }
    }

    void add_events(std::uint64_t count) {
        if (count == 0) return;
        add(sentence(count, "event", "events", "of late frames") +
            " are not listed. The lanes count them.");
    }

    void add_changes(const scenes::SceneFile& file, const SceneFrames& frames,
                     std::span<const scenes::ChangingObjects> changing) {
        for (std::size_t i = 0; i < changing.size(); ++i) {
            if (frames.live_models()[i].is_drawn) continue;
            if (changing[i].objects.front() >= frames.objects()) continue;  // told above
            const std::string name = printable(file.objects[changing[i].objects.front()].name);
            add("'" + name + "' deforms or tears, but is drawn at rest because it has " +
                std::to_string(changing[i].live.live().triangle_count()) + " triangles.");
        }
    }

private:
    void add(std::string text) {
        sentences.push_back(std::move(text));
    }
    void add_parts(std::uint64_t count, const char* one, const char* many) {
        if (count > 0)
            add(sentence(count, one, many, "in all shown frames together are not drawn."));
    }
};

std::string frames_text(const FrameWriter& writer, const SceneFrames& frames) {
    std::string text;
    for (const ShownFrame& shown : frames.frames()) {
        text += (text.empty() ? "" : ",\n") + compact(writer.json(shown));
    }
    return "[" + text + "]";
}

}  // namespace

ScenePage::ScenePage(const scenes::SceneFile& file, std::span<const scenes::SceneModel> models,
                     std::uint64_t count, const ScenePageOptions& options)
    : file_(file),
      models_(models),
      count_(count),
      options_(options),
      frames_(file, count, options.limits) {}

void ScenePage::list_events(std::uint64_t frame, const scenes::Simulation& simulation) {
    const auto number_of = [&](ObjectId id) {
        return static_cast<std::uint32_t>(&simulation.object(id) - file_.objects.data());
    };
    const auto list = [&](EventKind kind, std::uint32_t a, std::uint32_t b, std::size_t effect,
                          EventReason reason) {
        if (kind == EventKind::stays) return;
        if (events_.size() == options_.events) {
            ++events_left_out_;
            return;
        }
        static_assert(kSimulatedEffects.size() <= 16);
        events_.push_back({static_cast<std::uint32_t>(frame), a, b,
                           static_cast<std::uint32_t>(effect) +
                               16 * static_cast<std::uint32_t>(kind) +
                               64 * static_cast<std::uint32_t>(reason)});
    };
    for (const SceneEvent& event : simulation.scene().events()) {
        list(event.kind, number_of(event.a), number_of(event.b), effect_number(event.effect),
             event.reason);
    }
    if (simulation.response() == nullptr) return;
    for (const scenes::PushEvent& event : simulation.response()->push_events()) {
        list(event.kind, event.pair.a, event.pair.b, kSceneEffects.size(), EventReason::moved);
    }
}

Result<Done> ScenePage::add_frame(std::uint64_t frame, const scenes::Simulation& simulation) {
    timeline_.add(simulation);
    list_events(frame, simulation);
    return frames_.add(frame, simulation);
}

std::string ScenePage::finish(const scenes::Simulation& simulation,
                              std::span<const EffectCost> costs) {
    const Plan& plan = simulation.plan();
    const SceneGeometry geometry =
        draw_scene(file_, models_, frames_, simulation.changing(), options_.triangles);
    LeftOut words;
    words.add_frames(frames_, count_, file_.objects.size());
    words.add_models(file_, geometry, models_);
    words.add_events(events_left_out_);
    words.add_changes(file_, frames_, simulation.changing());
    left_out_ = std::move(words.sentences);

    const std::string name = std::filesystem::path(file_.name).filename().string();
    const Json data = {{"name", name},
                       {"frames", count_},
                       {"step_s", file_.step_s},
                       {"metres_per_unit", file_.metres_per_unit},
                       {"y_is_up", has_y_up(file_)},
                       {"centre", point_json(geometry.frame.centre)},
                       {"exponent", geometry.frame.exponent},
                       {"half", geometry.frame.half_box},
                       {"layers", file_.layers},
                       {"effects", effects_json(asked_effects(file_, plan), file_.dropped,
                                                computed_effects(simulation), costs)},
                       {"models", models_json(file_, geometry)},
                       {"objects", objects_json(file_, plan, frames_.objects())},
                       {"object_count", file_.objects.size()},
                       {"changing", changing_json(frames_, simulation.changing())},
                       {"spans", spans_json(timeline_)},
                       {"events", packed(events_)},
                       {"left_out", left_out_},
                       {"state_hash", hexadecimal(simulation.scene().state_hash())}};
    Json triangles = Json::array();
    for (const ModelDrawing& model : geometry.models) triangles.push_back(triangles_json(model));
    const auto element = [](const char* id, const std::string& json) {
        return script_element(id, kJsonType, script_json(json));
    };
    const std::array<std::pair<std::string_view, std::string>, 11> parts = {{
        {"@title@", escaped(valid_utf8(name)) + " - cdprep simulate"},
        {"@version@", escaped(options_.version)},
        {"@css@", std::string(page::kStyle) + std::string(page::kSceneStyle) + scene_chart_style()},
        {"@license@", escaped(page::kLicense)},
        {"@chart@", scene_chart(timeline_, file_.step_s)},
        {"@chart_words@", escaped(scene_chart_words(timeline_))},
        {"@data@",
         element("scene-data", compact(data)) + element("model-data", compact(triangles)) +
             element("frame-data", frames_text(FrameWriter(file_, geometry), frames_)) +
             element("plan-data", plan_json(file_, plan, models_, simulation.changing())) +
             element("plan-text", compact(plan_text(file_, plan, models_, simulation.changing())))},
        {"@three@", std::string(page::kThree)},
        {"@controls@", std::string(page::kControls)},
        {"@js@", std::string(page::kElements) + std::string(page::kView) +
                     std::string(page::kList) + std::string(page::kSceneData) +
                     std::string(page::kSceneView) + std::string(page::kSceneLanes) +
                     std::string(page::kScenePage)},
        {"@size@",
         "0 0 " + std::to_string(kSceneChartWidth) + " " + std::to_string(kSceneChartHeight)},
    }};
    return filled(page::kSceneFrame, parts);
}

}  // namespace cdprep::report
