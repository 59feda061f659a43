// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/simulation_report.h"

#include <algorithm>
#include <string>
#include <utility>

#include "cdprep/contacts.h"
#include "simulate/event_json.h"
#include "simulate/run_summary.h"
#include "text/json_layout.h"
#include "text/printable.h"

namespace cdprep::report {

SimulationReport::SimulationReport(const scenes::SceneFile& scene, const Plan& plan,
                                   EventFormat format, std::uint64_t frames)
    : scene_(scene),
      format_(format),
      frames_(frames),
      table_(scene, plan),
      not_computed_(not_computed(scene, plan)) {
    for (const scenes::AskedPair& pair : scene.pairs) {
        if (scene_effects(pair) != Ask::nothing) pairs_.push_back(&pair);
    }
}

std::string SimulationReport::begin() const {
    return format_ == EventFormat::json ? "{\"events\":[" : "";
}

bool SimulationReport::tells(const scenes::AskedPair& pair, EventKind kind) {
    if (kind == EventKind::stays) return pair.asked.lists_stays;
    return kind == EventKind::begins ? pair.tells_begins : pair.tells_ends;
}

bool SimulationReport::is_told(const scenes::PushEvent& event) const {
    const auto layers =
        std::minmax(scene_.objects[event.pair.a].layer, scene_.objects[event.pair.b].layer);
    return std::ranges::any_of(scene_.pairs, [&](const scenes::AskedPair& pair) {
        return contains(pair.asked.effects, Ask::response) &&
               std::minmax(pair.asked.a, pair.asked.b) == layers && tells(pair, event.kind);
    });
}

std::string SimulationReport::add_frame(std::uint64_t frame, const scenes::Simulation& simulation) {
    table_.add(simulation);
    std::string text;
    if (format_ == EventFormat::text) return text;
    const double time_s = static_cast<double>(frame) * scene_.step_s;
    if (const scenes::Response* response = simulation.response()) {
        for (const scenes::BodyEvent& event : response->events()) {
            text += event_text(body_event_json(frame, time_s, event, scene_));
        }
        for (const scenes::PushEvent& event : response->push_events()) {
            if (is_told(event)) text += event_text(push_event_json(frame, time_s, event, scene_));
        }
    }
    for (const SceneEvent& event : simulation.scene().events()) {
        if (!tells(*pairs_[event.pair], event.kind)) continue;
        text += event_text(event_json(frame, time_s, event, simulation));
    }
    return text;
}

std::string SimulationReport::event_text(const nlohmann::ordered_json& event) {
    const bool is_first = !std::exchange(has_event_, true);
    if (format_ == EventFormat::ndjson) return compact(event) + "\n";
    return (is_first ? "\n" : ",\n") + compact(event);
}

std::vector<std::string> SimulationReport::warnings(bool is_gltf) const {
    dynamics::DynamicsCounts fast = table_.body_counts(), cut = fast;
    fast.incomplete = cut.too_fast = 0;
    std::vector<std::string> sentences;
    for (const std::string& warning : response_warnings(cut)) {
        sentences.push_back(warning + (scene_.dynamics.most_contacts < kMostListedContacts
                                           ? ". Raise dynamics.most_contacts."
                                           : ": two bodies can have at most " +
                                                 std::to_string(kMostListedContacts) + "."));
    }
    for (const std::string& warning : response_warnings(fast)) {
        sentences.push_back(warning + ". Raise dynamics.most_speed or dynamics.substeps, or make " +
                            "the bodies continuous.");
    }
    for (std::string& sentence : sentences) {
        sentence.insert(0, printable(scene_.name) + ": ");
        if (is_gltf) sentence += " A glTF file cannot set these: write a scene file.";
    }
    return sentences;
}

std::string SimulationReport::finish(const scenes::Simulation& simulation) const {
    const RunSummary summary = {scene_, simulation, table_, costs_, not_computed_, frames_};
    switch (format_) {
        case EventFormat::text:
            return summary_text(summary);
        case EventFormat::json:
            return std::string(has_event_ ? "\n" : "") +
                   "],\n\"summary\":" + summary_json(summary) + "}\n";
        default:
            return "{\"summary\":" + summary_json(summary) + "}\n";
    }
}

}  // namespace cdprep::report
