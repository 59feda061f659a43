// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair_report.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

#include <nlohmann/json.hpp>

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

/// Returns whether there are triangles. Without any, all facts are true but meaningless.
bool has_triangles(const mesh::StoredVerdict& found) {
    return found.verdict.triangle_count > found.repeated_corners;
}

bool has(const mesh::StoredVerdict& found, format::VerdictFacts fact) {
    return has_triangles(found) && (found.verdict.facts & fact) != 0;
}

std::string verdict_line(const mesh::StoredVerdict& found,
                         const std::optional<mesh::SelfCrossing>& crossing) {
    if (!has_triangles(found)) return "no triangles";
    std::string line = has(found, format::verdict_closed) ? "closed" : "open";
    line += has(found, format::verdict_two_manifold) ? ", 2-manifold" : ", not 2-manifold";
    line += has(found, format::verdict_oriented) ? ", oriented" : ", not oriented";
    line += ", " + counted(found.components, "component", "components") + ", " +
            std::to_string(found.boundary_edges) + " boundary edges in " +
            std::to_string(found.verdict.boundary_loops) + " loops";
    if (crossing) {
        line += std::string(", ") + (crossing->is_complete ? "" : "at least ") +
                std::to_string(crossing->pairs) + " pairs that cross or touch";
    }
    return line;
}

const char* name_of(mesh::DropReason reason) {
    switch (reason) {
        case mesh::DropReason::out_of_range:
            return "out-of-range";
        case mesh::DropReason::not_finite:
            return "not-finite";
        case mesh::DropReason::repeated_corner:
            return "repeated-corner";
        case mesh::DropReason::duplicate:
            return "duplicate";
        case mesh::DropReason::zero_area:
            return "zero-area";
        case mesh::DropReason::inside:
            return "inside";
        case mesh::DropReason::small_component:
            break;
    }
    return "small-component";
}

std::int64_t plain(std::uint32_t source) {
    return source == mesh::kNone ? -1 : static_cast<std::int64_t>(source);
}

Json plain(const std::vector<std::uint32_t>& sources) {
    Json list = Json::array();
    for (const std::uint32_t source : sources) list.push_back(plain(source));
    return list;
}

std::string step_line(const mesh::StepReport& step) {
    std::string line = "  " + std::string(mesh::name_of(step.step)) + ":";
    const auto add = [&](std::uint64_t count, const char* what) {
        if (count > 0) line.append(1, ' ').append(std::to_string(count) + ' ').append(what) += ',';
    };
    add(step.dropped.size(), "triangles dropped");
    add(step.reversed.size(), "triangles reversed");
    add(step.cut.size(), "triangles cut");
    add(step.added_triangles, "triangles added");
    add(step.merged.size(), "vertices merged");
    add(step.unused.size(), "unused vertices removed");
    add(step.parted.size(), "vertices copied");
    add(step.added_vertices, "vertices added");
    add(step.refused.size(), "refused");
    if (line.back() == ',') line.back() = '.';
    if (step.moved > 0) line += " Moved by at most " + at_most_in_six_digits(step.moved) + ".";
    if (!step.undone.empty()) line += " Undone: " + step.undone + ".";
    return line + "\n";
}

Json to_json(const mesh::StoredVerdict& found) {
    return {{"closed", has(found, format::verdict_closed)},
            {"two_manifold", has(found, format::verdict_two_manifold)},
            {"oriented", has(found, format::verdict_oriented)},
            {"inside_defined", has(found, format::verdict_balanced)},
            {"boundary_edges", found.boundary_edges},
            {"boundary_loops", found.verdict.boundary_loops},
            {"non_manifold_edges", found.non_manifold_edges},
            {"non_manifold_vertices", found.non_manifold_vertices},
            {"inconsistent_edges", found.inconsistent_edges},
            {"duplicate_triangles", found.duplicate_triangles},
            {"repeated_corners", found.repeated_corners},
            {"components", found.components},
            {"closed_components", found.closed_components},
            {"inverted_components", found.inverted_components},
            {"euler", found.verdict.euler},
            {"area", found.verdict.area},
            {"volume", found.verdict.volume}};
}

void add_crossing(Json& json, const std::optional<mesh::SelfCrossing>& crossing) {
    const bool is_known = crossing && (crossing->is_complete || crossing->pairs > 0);
    json["self_crossing"] = is_known ? Json(crossing->pairs > 0) : Json();
    json["crossing_pairs"] = crossing ? Json(crossing->pairs) : Json();
    json["crossings_complete"] = crossing ? Json(crossing->is_complete) : Json();
}

Json to_json(const mesh::MovedDistance& moved) {
    return {{"lower", moved.lower}, {"upper", moved.upper}};
}

Json to_json(const mesh::RepairCounts& counts) {
    return {{"source_triangles", counts.source_triangles},
            {"kept", counts.kept},
            {"reversed", counts.reversed},
            {"cut", counts.cut},
            {"dropped", counts.dropped},
            {"made", counts.made},
            {"source_vertices", counts.source_vertices},
            {"merged_vertices", counts.merged_vertices},
            {"unused_vertices", counts.unused_vertices},
            {"parted_vertices", counts.parted_vertices},
            {"made_vertices", counts.made_vertices}};
}

Json to_json(const mesh::Refusal& refusal) {
    return {{"sentence", refusal.sentence},
            {"triangles", plain(refusal.triangles)},
            {"vertices", plain(refusal.vertices)},
            {"position", {refusal.position.x, refusal.position.y, refusal.position.z}},
            {"measure", refusal.measure}};
}

Json to_json(const mesh::StepReport& step) {
    Json json = {{"step", mesh::name_of(step.step)}};
    json["dropped"] = Json::array();
    for (const mesh::DroppedTriangle& dropped : step.dropped) {
        json["dropped"].push_back({{"triangle", plain(dropped.source)},
                                   {"reason", name_of(dropped.reason)},
                                   {"because", plain(dropped.because)}});
    }
    json["reversed"] = plain(step.reversed);
    json["cut"] = plain(step.cut);
    json["merged"] = Json::array();
    for (const mesh::MergedVertex& merged : step.merged) {
        json["merged"].push_back({{"vertex", plain(merged.source)},
                                  {"into", plain(merged.into)},
                                  {"distance", merged.distance}});
    }
    json["unused"] = plain(step.unused);
    json["copied"] = plain(step.parted);
    json["added_triangles"] = step.added_triangles;
    json["added_vertices"] = step.added_vertices;
    json["moved"] = step.moved;
    json["refused"] = Json::array();
    for (const mesh::Refusal& refusal : step.refused) json["refused"].push_back(to_json(refusal));
    if (!step.undone.empty()) json["undone"] = step.undone;
    return json;
}

/// Returns the count of each kind of change.
Json summary(const mesh::StepReport& step) {
    Json json = {{"step", mesh::name_of(step.step)},
                 {"dropped", step.dropped.size()},
                 {"reversed", step.reversed.size()},
                 {"cut", step.cut.size()},
                 {"merged", step.merged.size()},
                 {"copied", step.parted.size()},
                 {"added_triangles", step.added_triangles},
                 {"added_vertices", step.added_vertices},
                 {"moved", step.moved},
                 {"refused", step.refused.size()}};
    if (!step.undone.empty()) json["undone"] = step.undone;
    return json;
}

/// Adds the source numbers, or -1, and the steps that made or cut each, or null.
void add_origins(Json& json, const char* source, const char* step,
                 const std::vector<mesh::Origin>& origins) {
    json[source] = Json::array();
    json[step] = Json::array();
    for (const mesh::Origin& origin : origins) {
        json[source].push_back(plain(origin.source));
        json[step].push_back(origin.step ? Json(mesh::name_of(*origin.step)) : Json());
    }
}

}  // namespace

std::string repair_text(const RepairFileReport& report, std::size_t most_refusals) {
    const mesh::RepairReport& repair = report.repair;
    const mesh::RepairCounts& counts = repair.counts;
    std::string text = printable(report.output) + ": " +
                       counted(report.triangles, "triangle", "triangles") + ", " +
                       counted(report.vertices, "vertex", "vertices") + ", " +
                       printed(report.seconds, "%.3f") + " s\n";
    text += "  before: " + verdict_line(repair.before, report.crossing_before) + "\n";
    text += "  after:  " + verdict_line(repair.after, report.crossing_after) + "\n";
    if (has_triangles(repair.after))
        text +=
            "  (2-manifold by vertex numbers, as stored; validate joins equal positions first)\n";
    if (report.goal) text += *report.goal ? "  goal: reached\n" : "  goal: missed\n";
    text += "  " + counted(counts.source_triangles, "triangle", "triangles") + ": " +
            std::to_string(counts.kept) + " kept, " + std::to_string(counts.reversed) +
            " reversed, " + std::to_string(counts.cut) + " cut, " + std::to_string(counts.dropped) +
            " dropped; " + std::to_string(counts.made) + " new\n";
    text += "  distance from input to output at most " +
            at_most_in_six_digits(repair.input_to_output.upper) +
            ", from output to input at most " +
            at_most_in_six_digits(repair.output_to_input.upper) +
            (repair.settled ? "\n" : "; repairing again would change more\n");
    for (const mesh::StepReport& step : repair.steps) {
        text += step_line(step);
        for (std::size_t i = 0; i < step.refused.size() && i < most_refusals; ++i) {
            text += "    refused: " + step.refused[i].sentence + "\n";
        }
        if (step.refused.size() > most_refusals) {
            text += "    and " + std::to_string(step.refused.size() - most_refusals) +
                    " more refused; --format json has all\n";
        }
    }
    return text;
}

std::string repair_json(const RepairFileReport& report) {
    Json json = {{"input", report.input}, {"output", report.output}, {"exit", report.exit}};
    if (report.error) {
        json["error"] = *report.error;
    } else {
        const mesh::RepairReport& repair = report.repair;
        json["seconds"] = report.seconds;
        json["triangles"] = report.triangles;
        json["vertices"] = report.vertices;
        json["goal"] = report.goal ? Json(*report.goal) : Json();
        if (!report.missed.empty()) json["missed"] = report.missed;
        json["before"] = to_json(repair.before);
        add_crossing(json["before"], report.crossing_before);
        json["after"] = to_json(repair.after);
        add_crossing(json["after"], report.crossing_after);
        json["counts"] = to_json(repair.counts);
        json["input_to_output"] = to_json(repair.input_to_output);
        json["output_to_input"] = to_json(repair.output_to_input);
        json["settled"] = repair.settled;
        json["steps"] = Json::array();
        for (const mesh::StepReport& step : repair.steps) json["steps"].push_back(to_json(step));
        add_origins(json, "triangle_source", "triangle_step", report.triangle_origin);
        add_origins(json, "vertex_source", "vertex_step", report.vertex_origin);
    }
    return compact(json) + "\n";
}

std::string repair_summary_json(const mesh::RepairReport& repair) {
    Json json = {{"before", to_json(repair.before)},
                 {"after", to_json(repair.after)},
                 {"counts", to_json(repair.counts)},
                 {"input_to_output", to_json(repair.input_to_output)},
                 {"output_to_input", to_json(repair.output_to_input)},
                 {"settled", repair.settled}};
    json["steps"] = Json::array();
    for (const mesh::StepReport& step : repair.steps) json["steps"].push_back(summary(step));
    return compact(json);
}

}  // namespace cdprep::report
