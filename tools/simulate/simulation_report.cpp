// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/simulation_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <tuple>

#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

const char* reason_name(EventReason reason) {
    switch (reason) {
        case EventReason::moved:
            return "moved";
        case EventReason::removed:
            return "removed";
        case EventReason::relayered:
            return "relayered";
        case EventReason::paused:
            return "paused";
        case EventReason::unchanged:
            break;
    }
    return "unchanged";
}

const char* kind_name(EventKind kind) {
    if (kind == EventKind::stays) return "stays";
    return kind == EventKind::begins ? "begins" : "ends";
}

std::tuple<std::uint32_t, std::uint32_t> slots_of(const SceneSelfOverlaps& found) {
    return {found.object.slot, found.object.slot};
}
template <class Result>
std::tuple<std::uint32_t, std::uint32_t> slots_of(const Result& found) {
    return {found.a.slot, found.b.slot};
}

/// Returns the result of the objects of an event, or null.
template <class Result>
const Result* find_result(std::span<const Result> all, const SceneEvent& event) {
    const auto slots = [](const auto& found) { return slots_of(found); };
    const auto at =
        std::lower_bound(all.begin(), all.end(), event,
                         [&](const Result& x, const SceneEvent& y) { return slots(x) < slots(y); });
    return at != all.end() && slots(*at) == slots(event) ? &*at : nullptr;
}

const char* kind_name(ImpactKind kind) {
    switch (kind) {
        case ImpactKind::none:
            return "none";
        case ImpactKind::touching:
            return "touching";
        case ImpactKind::near:
            return "near";
        case ImpactKind::unfinished:
            break;
    }
    return "unfinished";
}

/// Adds bounds. JSON has no infinity, so an upper one is left out.
void add_bounds(Json& json, double lower, double upper) {
    json["lower"] = lower;
    if (std::isfinite(upper)) json["upper"] = upper;
}

/// Adds what an effect that holds has found.
void add_result(Json& json, const Scene& scene, const SceneEvent& event) {
    if (event.effect == Ask::distance) {
        if (const auto* found = find_result(scene.distances(), event)) {
            add_bounds(json, found->distance.lower, found->distance.upper);
        }
    } else if (event.effect == Ask::overlap) {
        const auto* found = find_result(scene.overlaps(), event);
        if (found) json["triangle_pairs"] = found->triangles.size();
    } else if (event.effect == Ask::self) {
        const auto* found = find_result(scene.self_overlaps(), event);
        if (found) json["triangle_pairs"] = found->triangles.size();
    } else if (event.effect == Ask::continuous) {
        if (const auto* found = find_result(scene.impacts(), event)) {
            json["kind"] = kind_name(found->impact.kind);
            add_bounds(json, found->impact.lower, found->impact.upper);
        }
    } else if (event.effect == Ask::haptic) {
        if (const auto* found = find_result(scene.bounded_distances(), event)) {
            json["late"] = !found->distance.is_complete;
            add_bounds(json, found->distance.lower, found->distance.upper);
        }
    } else if (event.effect == Ask::contacts) {
        if (const auto* found = find_result(scene.contacts(), event)) {
            json["contacts"] = found->contacts.size();
            add_bounds(json, found->contacts.front().lower, found->contacts.front().upper);
        }
    }
}

Json event_json(std::uint64_t frame, double time_s, const SceneEvent& event,
                const scenes::Simulation& simulation) {
    Json json = {{"frame", frame},
                 {"time_s", time_s},
                 {"event", kind_name(event.kind)},
                 {"effect", scenes::effect_name(event.effect)},
                 {"a", simulation.object(event.a).name},
                 {"b", simulation.object(event.b).name},
                 {"reason", reason_name(event.reason)}};
    if (event.kind != EventKind::ends) add_result(json, simulation.scene(), event);
    return json;
}

/// Returns wall time to show: nanoseconds would not be repeatable.
double milliseconds_of(double seconds) {
    return std::round(1e6 * seconds) / 1e3;
}

/// Returns the value of sorted ones below which this share of them lies; 0 without values.
double value_at(const std::vector<double>& sorted, double share) {
    if (sorted.empty()) return 0;
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(share * last)];
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
    : scene_(scene), format_(format), not_computed_(not_computed(plan)) {
    for (const scenes::AskedPair& pair : scene.pairs) {
        if (pair.asked.effects != Ask::nothing) pairs_.push_back(&pair);
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

void SimulationReport::count(const scenes::Simulation& simulation) {
    ++frames_;
    milliseconds_.push_back(milliseconds_of(simulation.step_seconds()));
    models_.work.add(simulation.change_work());
    models_.milliseconds.push_back(milliseconds_of(simulation.change_work().seconds));
    const SceneCounts& counts = simulation.scene().counts();
    counts_.moved += counts.moved;
    counts_.candidates += counts.candidates;
    counts_.kept += counts.kept;
    counts_.apart += counts.apart;
    for (std::size_t i = 0; i < counts.calls.size(); ++i) counts_.calls[i] += counts.calls[i];
    for (const SceneEvent& event : simulation.scene().events()) {
        Changes& changes = changes_[effect_number(event.effect)];
        changes.begins += event.kind == EventKind::begins ? 1 : 0;
        changes.ends += event.kind == EventKind::ends ? 1 : 0;
    }
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
                           {"calls", counts_.calls[i]},
                           {"begins", changes_[i].begins},
                           {"ends", changes_[i].ends}});
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
        {"state_hash", hexadecimal(simulation.scene().state_hash())}};
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

std::string SimulationReport::summary_text(const scenes::Simulation& simulation) const {
    const auto row = [](const auto&... cells) {
        std::array<char, 128> line{};
        std::snprintf(line.data(), line.size(), "%-12s %12s %12s %9s %9s\n", cells...);
        return std::string(line.data());
    };
    std::string text = row("effect", "calls", "calls/frame", "begins", "ends");
    const auto frames = static_cast<double>(std::max<std::uint64_t>(frames_, 1));
    for (std::size_t i = 0; i < kSceneEffects.size(); ++i) {
        if (!contains(simulation.plan().effects(), kSceneEffects[i])) continue;
        const std::uint64_t calls = counts_.calls[i];
        text += row(scenes::effect_name(kSceneEffects[i]).c_str(), std::to_string(calls).c_str(),
                    fixed(static_cast<double>(calls) / frames, 1).c_str(),
                    std::to_string(changes_[i].begins).c_str(),
                    std::to_string(changes_[i].ends).c_str());
    }
    for (const std::string& name : not_computed_) {
        text += "not computed: " + name + ", for no pair of layers asks\n";
    }
    text += "candidates " + std::to_string(counts_.candidates) + ": kept " +
            std::to_string(counts_.kept) + ", apart by their boxes " +
            std::to_string(counts_.apart) + "\n";
    text += counted(frames_, "frame", "frames") + " of " +
            counted(simulation.scene().object_count(), "object", "objects") + "; " +
            counted(simulation.grown_steps(), "frame", "frames") + " needed more room\n";
    text += changes_text(simulation);
    return text + "a frame took " + fixed(value_at(milliseconds_, 0.5), 3) +
           " ms (median), 95 % below " + fixed(value_at(milliseconds_, 0.95), 3) + " ms; state " +
           hexadecimal(simulation.scene().state_hash()) + "\n";
}

}  // namespace cdprep::report
