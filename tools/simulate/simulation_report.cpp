// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/simulation_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "simulate/event_json.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

/// Returns wall time to show: nanoseconds would not be repeatable.
double milliseconds_of(double seconds) {
    return std::round(1e6 * seconds) / 1e3;
}

/// Returns a share to show.
double rounded_share(double share) {
    return std::round(1e4 * share) / 1e4;
}

/// Returns the value of sorted ones below which this share of them lies; 0 without values.
double value_at(const std::vector<double>& sorted, double share) {
    if (sorted.empty()) return 0;
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(share * last)];
}

std::uint64_t nanoseconds_of(double seconds) {
    return static_cast<std::uint64_t>(std::llround(1e9 * seconds));
}

/// Returns how deep two bodies overlap, 0 if none do.
double deepest_contact(const scenes::Response& response) {
    double least = 0;
    for (const dynamics::BodyContact& contact : response.bodies().contacts()) {
        least = std::min(least, contact.distance);
    }
    return std::abs(least);
}

/// Returns the work of all frames, and the bodies as they are.
Json response_json(const scenes::Response& response, const dynamics::DynamicsCounts& counts) {
    return {{"bodies", response.moving().size()},
            {"awake", response.awake_count()},
            {"driven", response.driven_count()},
            {"calls", counts.pairs},
            {"contacts", counts.contacts},
            {"deep", counts.deep},
            {"shortened", counts.shortened},
            {"incomplete", counts.incomplete},
            {"too_fast", counts.too_fast},
            {"impacts", counts.impacts},
            {"deepest", deepest_contact(response)},
            {"state_hash", hexadecimal(response.bodies().state_hash())}};
}

/// The objects whose models change.
struct ChangingCounts {
    std::uint64_t deform = 0;
    std::uint64_t tear = 0;
    std::vector<std::string> missed;  ///< by the planes of their tears
};

ChangingCounts count_changing(const scenes::SceneFile& scene,
                              std::span<const scenes::ChangingObjects> changing) {
    ChangingCounts counts;
    for (const scenes::ChangingObjects& one : changing) {
        const scenes::Change& change = scene.changes[one.change];
        if (change.deform) counts.deform += one.objects.size();
        if (!change.tear) continue;
        counts.tear += one.objects.size();
        if (!one.live.cut().misses) continue;
        for (const std::uint32_t object : one.objects) {
            counts.missed.push_back(scene.objects[object].name);
        }
    }
    return counts;
}

}  // namespace

SimulationReport::SimulationReport(const scenes::SceneFile& scene, const Plan& plan,
                                   EventFormat format)
    : scene_(scene), format_(format), not_computed_(not_computed(scene, plan)) {
    for (const scenes::AskedPair& pair : scene.pairs) {
        if (scene_effects(pair) != Ask::nothing) pairs_.push_back(&pair);
    }
}

std::string SimulationReport::begin() const {
    return format_ == EventFormat::json ? "{\"events\":[" : "";
}

double SimulationReport::milliseconds_a_frame(std::uint64_t nanoseconds) const {
    const auto frames = static_cast<double>(std::max<std::uint64_t>(frames_, 1));
    return milliseconds_of(1e-9 * static_cast<double>(nanoseconds) / frames);
}

std::string SimulationReport::time_text(std::uint64_t nanoseconds) const {
    return fixed(milliseconds_a_frame(nanoseconds), 3) + " ms";
}

std::vector<std::string> SimulationReport::asked_by(Ask effect) const {
    std::vector<std::string> names;
    for (const scenes::AskedPair& pair : scene_.pairs) {
        if (!contains(pair.asked.effects, effect)) continue;
        names.push_back(printable(scene_.layers[pair.asked.a]) + "-" +
                        printable(scene_.layers[pair.asked.b]));
    }
    return names;
}

bool SimulationReport::is_told(const SceneEvent& event) const {
    const scenes::AskedPair& pair = *pairs_[event.pair];
    if (event.kind == EventKind::stays) return true;  // listed only where they are told
    return event.kind == EventKind::begins ? pair.tells_begins : pair.tells_ends;
}

void SimulationReport::count(const scenes::Simulation& simulation) {
    ++frames_;
    milliseconds_.push_back(milliseconds_of(simulation.frame_seconds()));
    count_response(simulation);
    models_.work.add(simulation.change_work());
    models_.milliseconds.push_back(milliseconds_of(simulation.change_work().seconds));
    const SceneCounts& counts = simulation.scene().counts();
    counts_.moved += counts.moved;
    counts_.candidates += counts.candidates;
    counts_.kept += counts.kept;
    counts_.apart += counts.apart;
    for (std::size_t i = 0; i < counts.calls.size(); ++i) {
        counts_.calls[i] += counts.calls[i];
        counts_.ticks[i] += counts.ticks[i];
    }
    counts_.box_ticks += counts.box_ticks;
    counts_.query_ticks += counts.query_ticks;
    counts_.list_ticks += counts.list_ticks;
    for (const SceneEvent& event : simulation.scene().events()) {
        Changes& changes = changes_[effect_number(event.effect)];
        changes.begins += event.kind == EventKind::begins ? 1 : 0;
        changes.ends += event.kind == EventKind::ends ? 1 : 0;
    }
}

void SimulationReport::count_response(const scenes::Simulation& simulation) {
    if (simulation.response() == nullptr) return;
    dynamics::DynamicsCounts& sum = response_.counts;
    const dynamics::DynamicsCounts& counts = simulation.response()->bodies().counts();
    sum.pairs += counts.pairs;
    sum.contacts += counts.contacts;
    sum.deep += counts.deep;
    sum.shortened += counts.shortened;
    sum.incomplete += counts.incomplete;
    sum.too_fast += counts.too_fast;
    sum.impacts += counts.impacts;
    response_.seconds += simulation.response_seconds();
}

std::string SimulationReport::add_frame(std::uint64_t frame, const scenes::Simulation& simulation) {
    count(simulation);
    std::string text;
    if (format_ == EventFormat::text) return text;
    const double time_s = static_cast<double>(frame) * scene_.step_s;
    for (const SceneEvent& event : simulation.scene().events()) {
        if (!is_told(event)) continue;
        const std::string line = compact(event_json(frame, time_s, event, simulation));
        if (format_ == EventFormat::ndjson) {
            text += line + "\n";
        } else {
            text += (has_event_ ? ",\n" : "\n") + line;
        }
        has_event_ = true;
    }
    return text;
}

std::string SimulationReport::finish(const scenes::Simulation& simulation) {
    std::sort(milliseconds_.begin(), milliseconds_.end());
    std::sort(models_.milliseconds.begin(), models_.milliseconds.end());
    switch (format_) {
        case EventFormat::text:
            return summary_text(simulation);
        case EventFormat::json:
            return std::string(has_event_ ? "\n" : "") +
                   "],\n\"summary\":" + summary_json(simulation) + "}\n";
        default:
            return "{\"summary\":" + summary_json(simulation) + "}\n";
    }
}

std::string SimulationReport::summary_json(const scenes::Simulation& simulation) const {
    Json effects = Json::array();
    for (std::size_t i = 0; i < kSceneEffects.size(); ++i) {
        if (!contains(simulation.plan().effects(), kSceneEffects[i])) continue;
        effects.push_back({{"name", scenes::effect_name(kSceneEffects[i])},
                           {"asked_by", asked_by(kSceneEffects[i])},
                           {"calls", counts_.calls[i]},
                           {"begins", changes_[i].begins},
                           {"ends", changes_[i].ends},
                           {"frame_ms", milliseconds_a_frame(counts_.ticks[i])}});
    }
    Json summary = {
        {"scene", scene_.name},
        {"version", CDPREP_VERSION},
        {"frames", frames_},
        {"objects", simulation.scene().object_count()},
        {"moved", counts_.moved},
        {"candidates", counts_.candidates},
        {"kept", counts_.kept},
        {"apart", counts_.apart},
        {"effects", effects},
        {"not_computed", not_computed_},
        {"grown_steps", simulation.grown_steps()},
        {"step_ms",
         {{"median", value_at(milliseconds_, 0.5)}, {"p95", value_at(milliseconds_, 0.95)}}},
        {"stages_ms",
         {{"boxes", milliseconds_a_frame(counts_.box_ticks)},
          {"rest_of_pairs",
           milliseconds_a_frame(rest_of_pairs(counts_, simulation.thread_count()))},
          {"lists", milliseconds_a_frame(counts_.list_ticks)}}},
        {"state_hash", hexadecimal(simulation.scene().state_hash())}};
    for (const scenes::EffectCost& cost : costs_) {
        summary["costs"].push_back({{"without", scenes::effect_name(cost.effect)},
                                    {"change_of_time", rounded_share(cost.change)},
                                    {"spread_of_time", rounded_share(cost.spread)}});
    }
    if (simulation.response() != nullptr) {
        Json& response = summary["response"];
        response = response_json(*simulation.response(), response_.counts);
        response["asked_by"] = asked_by(Ask::response);
        response["frame_ms"] = milliseconds_a_frame(nanoseconds_of(response_.seconds));
    }
    if (!simulation.changing().empty()) {
        const ChangingCounts changing = count_changing(scene_, simulation.changing());
        summary["changes"] = {{"deform", changing.deform}, {"tear", changing.tear},
                              {"missed", changing.missed}, {"refits", models_.work.refits},
                              {"torn", models_.work.torn}, {"parts", models_.work.parts}};
        summary["refit_ms"] = {{"median", value_at(models_.milliseconds, 0.5)},
                               {"p95", value_at(models_.milliseconds, 0.95)}};
    }
    return compact(summary);
}

/// What the numbers of the table do not say about the bodies.
std::string SimulationReport::response_text(const scenes::Simulation& simulation) const {
    if (simulation.response() == nullptr) return "";
    const scenes::Response& response = *simulation.response();
    const dynamics::DynamicsCounts& counts = response_.counts;
    std::string text = counted(response.moving().size(), "body", "bodies") + ", " +
                       std::to_string(response.awake_count()) +
                       " awake at the end: " + counted(counts.contacts, "contact", "contacts") +
                       ", " + std::to_string(counts.deep) + " deep, " +
                       std::to_string(counts.shortened) + " shortened; " +
                       counted(counts.impacts, "impact", "impacts") +
                       "; deepest overlap at the end " + number_text(deepest_contact(response)) +
                       "; state " + hexadecimal(response.bodies().state_hash()) + "\n";
    if (counts.incomplete > 0) {
        text += counted(counts.incomplete, "list", "lists") +
                " of contacts were cut short. Raise dynamics.most_contacts.\n";
    }
    if (counts.too_fast > 0) {
        text += counted(counts.too_fast, "body was", "bodies were") +
                " faster than contacts can follow, counted in each substep. Raise "
                "dynamics.most_speed or dynamics.substeps.\n";
    }
    return text;
}

std::string SimulationReport::changes_text(const scenes::Simulation& simulation) const {
    if (simulation.changing().empty()) return "";
    const ChangingCounts changing = count_changing(scene_, simulation.changing());
    std::string text = counted(changing.deform, "object deforms", "objects deform") + ", " +
                       counted(changing.tear, "tears", "tear") + ": " +
                       counted(models_.work.refits, "refit", "refits") + ", " +
                       counted(models_.work.torn, "triangle", "triangles") + " torn into " +
                       counted(models_.work.parts, "part", "parts") +
                       "; the refits of a frame took " +
                       fixed(value_at(models_.milliseconds, 0.5), 3) + " ms (median)\n";
    for (const std::string& name : changing.missed) {
        text += "object '" + printable(name) + "' is not torn, for the plane misses its model\n";
    }
    return text;
}

std::string SimulationReport::effects_text(const scenes::Simulation& simulation) const {
    const auto row = [](const auto&... cells) {
        std::array<char, 128> line{};
        std::snprintf(line.data(), line.size(), "%-12s %12s %12s %9s %9s  %s", cells...);
        return std::string(line.data());
    };
    std::string text =
        row("effect", "calls", "calls/frame", "begins", "ends", "time/frame") + "  asked by\n";
    const auto frames = static_cast<double>(std::max<std::uint64_t>(frames_, 1));
    for (std::size_t i = 0; i < kSceneEffects.size(); ++i) {
        if (!contains(simulation.plan().effects(), kSceneEffects[i])) continue;
        const std::uint64_t calls = counts_.calls[i];
        text += row(scenes::effect_name(kSceneEffects[i]).c_str(), std::to_string(calls).c_str(),
                    fixed(static_cast<double>(calls) / frames, 1).c_str(),
                    std::to_string(changes_[i].begins).c_str(),
                    std::to_string(changes_[i].ends).c_str(), time_text(counts_.ticks[i]).c_str());
        for (const std::string& pair : asked_by(kSceneEffects[i])) text += "  " + pair;
        text += "\n";
    }
    if (simulation.response() != nullptr) {
        const std::uint64_t calls = response_.counts.pairs;
        text += row("response", std::to_string(calls).c_str(),
                    fixed(static_cast<double>(calls) / frames, 1).c_str(), "-", "-",
                    time_text(nanoseconds_of(response_.seconds)).c_str());
        for (const std::string& pair : asked_by(Ask::response)) text += "  " + pair;
        text += "\n";
    }
    return text + "boxes and broad phase " + time_text(counts_.box_ticks) + ", rest of pairs " +
           time_text(rest_of_pairs(counts_, simulation.thread_count())) + ", lists and events " +
           time_text(counts_.list_ticks) + "\n";
}

std::string SimulationReport::costs_text() const {
    std::string text;
    for (const scenes::EffectCost& cost : costs_) {
        text += "without " + scenes::effect_name(cost.effect) + ", all frames take " +
                fixed(100 * (1 + cost.change), 1) + " % of the time (spread " +
                fixed(100 * cost.spread, 1) + " %)\n";
    }
    return text;
}

std::string SimulationReport::summary_text(const scenes::Simulation& simulation) const {
    std::string text = effects_text(simulation) + costs_text();
    for (const std::string& name : not_computed_) {
        text += "not computed: " + name + ", for no pair of layers asks\n";
    }
    text += "candidates " + std::to_string(counts_.candidates) + ": kept " +
            std::to_string(counts_.kept) + ", apart by their boxes " +
            std::to_string(counts_.apart) + "\n";
    text += counted(frames_, "frame", "frames") + " of " +
            counted(simulation.scene().object_count(), "object", "objects") + "; " +
            counted(simulation.grown_steps(), "frame", "frames") + " needed more room\n";
    text += changes_text(simulation) + response_text(simulation);
    return text + "a frame took " + fixed(value_at(milliseconds_, 0.5), 3) +
           " ms (median), 95 % below " + fixed(value_at(milliseconds_, 0.95), 3) + " ms; state " +
           hexadecimal(simulation.scene().state_hash()) + "\n";
}

}  // namespace cdprep::report
