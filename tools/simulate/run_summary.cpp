// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/run_summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "simulate/run/section_use.h"
#include "simulate/run/unpaired_layers.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

/// Returns wall time to show. A short frame takes less than a microsecond.
double milliseconds(std::uint64_t nanoseconds) {
    return static_cast<double>(nanoseconds) / 1e6;
}

/// Returns the time of a frame: the mean of so many.
double frame_ms(std::uint64_t nanoseconds, std::uint64_t frames) {
    return milliseconds(nanoseconds / std::max<std::uint64_t>(frames, 1));
}

/// Returns a share to show.
double rounded_share(double share) {
    return std::round(1e4 * share) / 1e4;
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

/// Returns how deep two bodies overlap, 0 if none do.
double deepest_contact(const scenes::Response& response) {
    double least = 0;
    for (const dynamics::BodyContact& contact : response.bodies().contacts()) {
        least = std::min(least, contact.distance);
    }
    return std::abs(least);
}

/// The sections of all open models.
struct AllSections {
    std::uint64_t unread = 0;
    std::uint64_t unread_bytes = 0;
    std::uint64_t bytes = 0;
};

AllSections sections_of_models(std::span<const scenes::SceneModel> models) {
    AllSections all;
    for (const scenes::SceneModel& model : models) {
        if (!model.model) continue;
        const SectionUse use = use_of(*model.model);
        all.unread += use.untouched.rows.size();
        all.unread_bytes += use.untouched.bytes;
        all.bytes += use.read.bytes + use.untouched.bytes;
    }
    return all;
}

// --- Text -------------------------------------------------------------------------------

/// Returns a line of the table, with cells to the right but the first and the last.
std::string line_of(const std::array<std::string, 8>& cells, const std::string& last) {
    constexpr std::array kWidths = {-22, 12, 12, 11, 9, 11, 8, 8};
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::array<char, 64> cell{};
        std::snprintf(cell.data(), cell.size(), "%*s", kWidths[i], cells[i].c_str());
        line += cell.data();
    }
    if (!last.empty()) line += "  " + last;
    return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
}

/// Returns a number in three digits or, from 1000 on, as a whole one.
std::string three_digits(double number) {
    const int places = number >= 100 ? 0 : number >= 10 ? 1 : 2;
    return fixed(number, places);
}

std::string time_text(double nanoseconds) {
    if (nanoseconds < 1e6) return three_digits(1e-3 * nanoseconds) + " us";
    return three_digits(1e-6 * nanoseconds) + " ms";
}
std::string time_text(std::uint64_t nanoseconds) {
    return time_text(static_cast<double>(nanoseconds));
}

/// Returns the mean time of a frame.
std::string frame_text(std::uint64_t nanoseconds, std::uint64_t frames) {
    return time_text(static_cast<double>(nanoseconds) /
                     static_cast<double>(std::max<std::uint64_t>(frames, 1)));
}

std::string bytes_text(std::uint64_t bytes) {
    const auto count = static_cast<double>(bytes);
    if (bytes < 1000) return std::to_string(bytes) + " B";
    if (bytes < 1'000'000) return three_digits(1e-3 * count) + " kB";
    return three_digits(1e-6 * count) + " MB";
}

/// Returns "-12.3 % (spread 0.6)": how the time of all frames changes without an effect.
std::string cost_text(std::span<const EffectCost> costs, Ask effect) {
    const auto at = std::ranges::find(costs, effect, &EffectCost::effect);
    if (at == costs.end()) return "";
    const double percent = 100 * at->change;
    return (percent > 0 ? "+" : "") + fixed(percent, 1) + " % (spread " +
           fixed(100 * at->spread, 1) + ")";
}

std::string effect_line(const RunSummary& summary, const EffectRow& row) {
    const std::uint64_t frames = summary.table.frames();
    std::string last;
    for (const std::string& pair : row.asked_by) last += (last.empty() ? "" : "  ") + pair;
    const std::string cost = cost_text(summary.costs, row.effect);
    if (!cost.empty()) last = cost + "  " + last;
    const double calls =
        static_cast<double>(row.calls) / static_cast<double>(std::max<std::uint64_t>(frames, 1));
    return line_of(
        {scenes::effect_name(row.effect), fixed(calls, 1), frame_text(row.nanoseconds, frames),
         time_text(row.p99), bytes_text(row.state_bytes), bytes_text(row.read_bytes),
         std::to_string(row.begins), std::to_string(row.ends)},
        last);
}

std::string table_text(const RunSummary& summary) {
    const std::uint64_t frames = summary.table.frames();
    std::string text = line_of(
        {"effect", "calls/frame", "time/frame", "p99", "state", "sections", "begins", "ends"},
        summary.costs.empty() ? "requested by" : "time without it  requested by");
    for (const EffectRow& row : summary.table.effects(summary.simulation)) {
        text += effect_line(summary, row);
    }
    for (const PartRow& row : summary.table.parts()) {
        text += line_of({row.name, "", frame_text(row.nanoseconds, frames)}, "");
    }
    const std::uint64_t all = summary.table.frame_times().sum();
    // Frames that do nothing take as long as the clock, whose readings no row has.
    constexpr std::uint64_t kShort = 10'000;
    const bool is_long = all > kShort * frames;
    text += line_of(
        {"frame", "", frame_text(all, frames)},
        is_long ? "the rows add up to " + fixed(100 * summary.table.explained(), 1) + " % of it"
                : "");
    const std::size_t threads = summary.simulation.thread_count();
    if (threads > 1) {
        text += "times of effects are means over " + std::to_string(threads) + " threads\n";
    }
    return text;
}

std::string changes_text(const RunSummary& summary) {
    if (summary.simulation.changing().empty()) return "";
    const ChangingCounts changing = count_changing(summary.scene, summary.simulation.changing());
    const scenes::ChangeWork& work = summary.table.change_work();
    std::string text = counted(changing.deform, "object deforms", "objects deform") + ", " +
                       counted(changing.tear, "tears", "tear") + ": " +
                       counted(work.refits, "refit", "refits") + ", " +
                       counted(work.rebuilt, "triangle", "triangles") + " rebuilt, " +
                       counted(work.torn, "triangle", "triangles") + " torn and " +
                       std::to_string(work.appended) + " appended; the changes of a frame took " +
                       time_text(summary.table.refit_times().at(0.5)) + " (median)\n";
    for (const std::string& name : changing.missed) {
        text += "object '" + printable(name) + "' is not torn: the plane misses its model\n";
    }
    return text;
}

/// What the table does not say about the bodies.
std::string response_text(const RunSummary& summary) {
    const scenes::Response* response = summary.simulation.response();
    if (response == nullptr) {
        return scenes::has_response(summary.scene)
                   ? "response was not computed: the poses are from the recording\n"
                   : "";
    }
    const dynamics::DynamicsCounts& counts = summary.table.body_counts();
    std::string text = counted(response->moving().size(), "body", "bodies") + ", " +
                       std::to_string(response->awake_count()) +
                       " awake at the end: " + counted(counts.contacts, "contact", "contacts") +
                       ", " + std::to_string(counts.deep) + " deep, " +
                       std::to_string(counts.shortened) + " shortened; " +
                       counted(counts.impacts, "impact", "impacts") +
                       "; deepest overlap at the end " + number_text(deepest_contact(*response)) +
                       "; state " + hexadecimal(response->bodies().state_hash()) + "\n";
    if (response->box_count() > 0) {
        text += counted(response->box_count(), "body has the inertia of its box: its file has",
                        "bodies have the inertia of their boxes: their files have") +
                " no usable mass properties\n";
    }
    for (const std::string& warning : response_warnings(counts)) text += warning + ".\n";
    return text;
}

/// The effects that are not computed, and the sections that are not read.
std::string not_computed_text(const RunSummary& summary) {
    std::string text = not_computed_lines(summary.scene, summary.not_computed);
    const AllSections sections = sections_of_models(summary.simulation.models());
    text += "not read: " + counted(sections.unread, "section", "sections") + ", " +
            bytes_text(sections.unread_bytes) + " of " + bytes_text(sections.bytes) + "\n";
    return text + unpaired_text(summary.scene);
}

// --- JSON -------------------------------------------------------------------------------

Json effects_json(const RunSummary& summary, const std::vector<EffectRow>& rows) {
    Json effects = Json::array();
    for (const EffectRow& row : rows) {
        if (row.effect == Ask::response) continue;
        effects.push_back({{"name", scenes::effect_name(row.effect)},
                           {"asked_by", row.asked_by},
                           {"calls", row.calls},
                           {"begins", row.begins},
                           {"ends", row.ends},
                           {"frame_ms", frame_ms(row.nanoseconds, summary.table.frames())},
                           {"p99_ms", milliseconds(row.p99)},
                           {"state_bytes", row.state_bytes},
                           {"read_bytes", row.read_bytes}});
    }
    return effects;
}

Json response_json(const RunSummary& summary, const EffectRow& row) {
    const scenes::Response& response = *summary.simulation.response();
    const dynamics::DynamicsCounts& counts = summary.table.body_counts();
    return {{"asked_by", row.asked_by},
            {"bodies", response.moving().size()},
            {"awake", response.awake_count()},
            {"driven", response.driven_count()},
            {"boxes", response.box_count()},
            {"calls", row.calls},
            {"begins", row.begins},
            {"ends", row.ends},
            {"contacts", counts.contacts},
            {"deep", counts.deep},
            {"shortened", counts.shortened},
            {"incomplete", counts.incomplete},
            {"too_fast", counts.too_fast},
            {"impacts", counts.impacts},
            {"deepest", deepest_contact(response)},
            {"frame_ms", frame_ms(row.nanoseconds, summary.table.frames())},
            {"p99_ms", milliseconds(row.p99)},
            {"state_bytes", row.state_bytes},
            {"read_bytes", row.read_bytes},
            {"state_hash", hexadecimal(response.bodies().state_hash())}};
}

Json times_json(const TimeHistogram& times) {
    return {{"mean", frame_ms(times.sum(), times.count())},
            {"median", milliseconds(times.at(0.5))},
            {"p95", milliseconds(times.at(0.95))}};
}

void add_not_computed(Json& json, const RunSummary& summary) {
    json["not_computed"] = summary.not_computed;
    json["not_built"] = not_built();
    const AllSections sections = sections_of_models(summary.simulation.models());
    json["sections"] = {{"unread", sections.unread},
                        {"unread_bytes", sections.unread_bytes},
                        {"bytes", sections.bytes}};
    json["unpaired"] = unpaired_json(summary.scene);
}

void add_changes(Json& json, const RunSummary& summary) {
    if (summary.simulation.changing().empty()) return;
    const ChangingCounts changing = count_changing(summary.scene, summary.simulation.changing());
    const scenes::ChangeWork& work = summary.table.change_work();
    json["changes"] = {{"deform", changing.deform}, {"tear", changing.tear},
                       {"missed", changing.missed}, {"refits", work.refits},
                       {"rebuilt", work.rebuilt},   {"torn", work.torn},
                       {"appended", work.appended}};
    json["changes_ms"] = times_json(summary.table.refit_times());
}

void add_costs(Json& json, const RunSummary& summary) {
    for (const EffectCost& cost : summary.costs) {
        json["costs"].push_back({{"without", scenes::effect_name(cost.effect)},
                                 {"change_of_time", rounded_share(cost.change)},
                                 {"spread_of_time", rounded_share(cost.spread)}});
    }
}

Json stages_json(const RunSummary& summary) {
    const std::vector<PartRow> parts = summary.table.parts();
    const std::uint64_t frames = summary.table.frames();
    return {{"boxes", frame_ms(parts[0].nanoseconds, frames)},
            {"rest_of_pairs", frame_ms(parts[1].nanoseconds, frames)},
            {"lists", frame_ms(parts[2].nanoseconds, frames)}};
}

}  // namespace

std::vector<std::string> response_warnings(const dynamics::DynamicsCounts& counts) {
    std::vector<std::string> warnings;
    if (counts.incomplete > 0) {
        warnings.push_back(
            counted(counts.incomplete, "list of contacts was", "lists of contacts were") +
            " cut short");
    }
    if (counts.too_fast > 0) {
        warnings.push_back(counted(counts.too_fast, "body was", "bodies were") +
                           " too fast for the search for contacts, counted in each substep");
    }
    return warnings;
}

std::string summary_text(const RunSummary& summary) {
    const SceneCounts& counts = summary.table.counts();
    const TimeHistogram& times = summary.table.frame_times();
    const scenes::Simulation& simulation = summary.simulation;
    return table_text(summary) + not_computed_text(summary) + "candidates " +
           std::to_string(counts.candidates) + ": kept " + std::to_string(counts.kept) +
           ", with disjoint boxes " + std::to_string(counts.apart) + "\nframes " +
           std::to_string(summary.table.frames()) + " of " + std::to_string(summary.frames) +
           " complete; " + counted(simulation.scene().object_count(), "object", "objects") + "; " +
           counted(simulation.grown_steps(), "frame", "frames") + " needed more room\n" +
           changes_text(summary) + response_text(summary) + "a frame took " +
           time_text(times.at(0.5)) + " (median), 95 % below " + time_text(times.at(0.95)) +
           "; state " + hexadecimal(simulation.scene().state_hash()) + "\n";
}

std::string summary_json(const RunSummary& summary) {
    const SceneCounts& counts = summary.table.counts();
    const scenes::Simulation& simulation = summary.simulation;
    const std::vector<EffectRow> rows = summary.table.effects(simulation);
    Json json = {{"scene", summary.scene.name},
                 {"version", CDPREP_VERSION},
                 {"frames", summary.table.frames()},
                 {"objects", simulation.scene().object_count()},
                 {"moved", counts.moved},
                 {"candidates", counts.candidates},
                 {"kept", counts.kept},
                 {"apart", counts.apart},
                 {"effects", effects_json(summary, rows)}};
    add_not_computed(json, summary);
    json["grown_steps"] = simulation.grown_steps();
    json["frame_ms"] = times_json(summary.table.frame_times());
    json["stages_ms"] = stages_json(summary);
    json["explained"] = rounded_share(summary.table.explained());
    json["state_hash"] = hexadecimal(simulation.scene().state_hash());
    add_costs(json, summary);
    if (simulation.response() != nullptr) {
        json["response"] = response_json(summary, rows.back());
    } else if (scenes::has_response(summary.scene)) {
        json["response_is_replayed"] = true;
    }
    add_changes(json, summary);
    return compact(json);
}

}  // namespace cdprep::report
