// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/simulation_report.h"

#include "simulate/event_json.h"
#include "simulate/run_summary.h"
#include "text/json_layout.h"

namespace cdprep::report {

SimulationReport::SimulationReport(const scenes::SceneFile& scene, const Plan& plan,
                                   EventFormat format)
    : scene_(scene),
      format_(format),
      table_(scene, plan),
      not_computed_(not_computed(scene, plan)) {
    for (const scenes::AskedPair& pair : scene.pairs) {
        if (scene_effects(pair) != Ask::nothing) pairs_.push_back(&pair);
    }
}

std::string SimulationReport::begin() const {
    return format_ == EventFormat::json ? "{\"events\":[" : "";
}

bool SimulationReport::is_told(const SceneEvent& event) const {
    const scenes::AskedPair& pair = *pairs_[event.pair];
    if (event.kind == EventKind::stays) return true;  // listed only where they are told
    return event.kind == EventKind::begins ? pair.tells_begins : pair.tells_ends;
}

std::string SimulationReport::add_frame(std::uint64_t frame, const scenes::Simulation& simulation) {
    table_.add(simulation);
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

std::string SimulationReport::finish(const scenes::Simulation& simulation) const {
    const RunSummary summary = {scene_, simulation, table_, costs_, not_computed_};
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
