// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/validation_json.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "text/file_uri.h"
#include "text/json_layout.h"
#include "text/verdict_words.h"
#include "validate/fingerprint.h"
#include "validate/place_text.h"
#include "validate/severity_name.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

struct CountName {
    const char* name;
    std::uint64_t mesh::DefectCounts::*count;
};

constexpr std::array<CountName, 25> kCounts = {{
    {"non_finite_vertices", &mesh::DefectCounts::non_finite_vertices},
    {"out_of_range_triangles", &mesh::DefectCounts::out_of_range_triangles},
    {"unreferenced_vertices", &mesh::DefectCounts::unreferenced_vertices},
    {"duplicate_vertices", &mesh::DefectCounts::duplicate_vertices},
    {"degenerate_triangles", &mesh::DefectCounts::degenerate_triangles},
    {"zero_area_triangles", &mesh::DefectCounts::zero_area_triangles},
    {"sliver_triangles", &mesh::DefectCounts::sliver_triangles},
    {"duplicate_triangles", &mesh::DefectCounts::duplicate_triangles},
    {"opposite_triangles", &mesh::DefectCounts::opposite_triangles},
    {"boundary_edges", &mesh::DefectCounts::boundary_edges},
    {"boundary_loops", &mesh::DefectCounts::boundary_loops},
    {"non_manifold_edges", &mesh::DefectCounts::non_manifold_edges},
    {"non_manifold_vertices", &mesh::DefectCounts::non_manifold_vertices},
    {"inconsistent_edges", &mesh::DefectCounts::inconsistent_edges},
    {"non_orientable_components", &mesh::DefectCounts::non_orientable_components},
    {"t_junctions", &mesh::DefectCounts::t_junctions},
    {"near_seams", &mesh::DefectCounts::near_seams},
    {"components", &mesh::DefectCounts::components},
    {"inverted_components", &mesh::DefectCounts::inverted_components},
    {"nested_components", &mesh::DefectCounts::nested_components},
    {"overlapping_components", &mesh::DefectCounts::overlapping_components},
    {"crossing_pairs", &mesh::DefectCounts::crossing_pairs},
    {"touching_pairs", &mesh::DefectCounts::touching_pairs},
    {"coplanar_overlap_pairs", &mesh::DefectCounts::coplanar_overlap_pairs},
    {"self_intersecting_pairs", &mesh::DefectCounts::self_intersecting_pairs},
}};
static_assert(sizeof(mesh::DefectCounts) == kCounts.size() * sizeof(std::uint64_t));

/// A hole may have a million vertices; its report lists only the first.
constexpr std::size_t kMostJsonNumbers = 100;

/// Adds the first numbers under `name`. If there are more, adds their full count under
/// `count_name`.
void add_numbers(Json& json, const char* name, const char* count_name,
                 const std::vector<std::uint32_t>& numbers) {
    const auto shown = static_cast<std::ptrdiff_t>(std::min(numbers.size(), kMostJsonNumbers));
    json[name] = std::vector<std::uint32_t>(numbers.begin(), numbers.begin() + shown);
    if (numbers.size() > kMostJsonNumbers) json[count_name] = numbers.size();
}

/// Returns the paths of the nodes of a place's triangles, each once, in triangle order.
std::vector<std::string> nodes_of(const ValidationReport& report, const mesh::Place& place) {
    std::vector<std::string> nodes;
    const std::size_t shown = std::min(place.triangles.size(), kMostJsonNumbers);
    for (std::size_t i = 0; i < shown; ++i) {
        std::string node = node_of(report, place.triangles[i]);
        const bool is_new = std::find(nodes.begin(), nodes.end(), node) == nodes.end();
        if (!node.empty() && is_new) nodes.push_back(std::move(node));
    }
    return nodes;
}

Json place_json(const ValidationReport& report, mesh::Rule rule, const mesh::Place& place,
                std::uint64_t fingerprint) {
    Json json = Json::object();
    add_numbers(json, "triangles", "triangle_count", place.triangles);
    add_numbers(json, "vertices", "vertex_count", place.vertices);
    const std::vector<std::string> nodes = nodes_of(report, place);
    if (!nodes.empty()) json["node"] = nodes.front();
    if (nodes.size() > 1) json["nodes"] = nodes;
    json["position"] = position_json(place.position);
    if (*mesh::text_of(rule).measure != '\0') json["measure"] = place.measure;
    json["fingerprint"] = fingerprint_text(fingerprint);
    return json;
}

Json finding_json(const ValidationReport& report, std::size_t i, const ValidationRun& run) {
    const mesh::Finding& finding = report.defects.findings[i];
    const Judgement& judgement = report.judgements[i];
    Json json = {{"rule", mesh::id_of(finding.rule)},
                 {"name", mesh::text_of(finding.rule).name},
                 {"severity", severity_name(judgement.severity)},
                 {"count", finding.count}};
    if (finding.is_lower_bound) json["lower_bound"] = true;
    if (!run.baseline.empty()) json["new"] = judgement.fresh;
    json["places"] = Json::array();
    const std::size_t shown = std::min(finding.places.size(), run.max_places);
    for (std::size_t k = 0; k < shown; ++k) {
        json["places"].push_back(
            place_json(report, finding.rule, finding.places[k], judgement.fingerprints[k]));
    }
    return json;
}

Json verdict_json(const format::Verdict& verdict) {
    const bool has_genus = verdict.genus >= 0;
    const bool has_volume = (verdict.facts & format::verdict_balanced) != 0;
    return {{"facts", fact_words(verdict)},
            {"promises", promise_words(verdict)},
            {"triangles", verdict.triangle_count},
            {"first_triangle", verdict.first_triangle},
            {"boundary_loops", verdict.boundary_loops},
            {"euler", verdict.euler},
            {"genus", has_genus ? Json(verdict.genus) : Json()},
            {"area", verdict.area},
            {"volume", has_volume ? Json(verdict.volume) : Json()}};
}

void add_verdicts(Json& json, const ValidationReport& report, const ValidationRun& run) {
    const std::vector<format::Verdict>& verdicts = report.defects.verdicts;
    if (verdicts.empty()) return;
    json["verdict"] = verdict_json(verdicts[0]);
    json["components"] = Json::array();
    const std::size_t shown = std::min(verdicts.size() - 1, run.max_places);
    for (std::size_t i = 1; i <= shown; ++i) {
        json["components"].push_back(verdict_json(verdicts[i]));
    }
}

Json mesh_json(const ValidationReport& report, const ValidationRun& run) {
    Json json = {{"input", report.input},
                 {"uri", file_uri(report.input, run.folder)},
                 {"exit", report.exit}};
    if (report.error) {
        json["error"] = *report.error;
        if (!run.baseline.empty()) json["known"] = report.known_error ? 1 : 0;
        return json;
    }
    json["triangles"] = report.triangles;
    json["vertices"] = report.vertices;
    json["counts"] = counts_json(report.defects.counts);
    json["crossings_complete"] = report.defects.crossings_complete;
    if (!report.defects.t_junctions_complete) json["t_junctions_complete"] = false;
    json["findings"] = Json::array();
    for (std::size_t i = 0; i < report.defects.findings.size(); ++i) {
        json["findings"].push_back(finding_json(report, i, run));
    }
    if (!run.baseline.empty()) json["known"] = report.known;
    if (!report.remarks.empty()) json["remarks"] = report.remarks;
    add_verdicts(json, report, run);
    if (!run.timings) return json;
    json["seconds"] = report.seconds;
    for (const StageTime& stage : report.stages) json["stages"][stage.stage] = stage.seconds;
    return json;
}

/// Returns one member of an object, without the comma after it.
std::string member(const char* name, const Json& value) {
    return compact(name) + ":" + laid_out(value, 1);
}

}  // namespace

std::string validation_json_head(const ValidationRun& run) {
    const Json options = {{"weld", run.weld_distance},
                          {"seam", run.seam_width},
                          {"crossings", run.crossings},
                          {"max_pairs", run.max_pairs},
                          {"max_issues", run.max_places}};
    const Json baseline = run.baseline.empty() ? Json() : Json(run.baseline);
    std::string text = "{";
    text += member("report", kValidationReportName) + ",\n ";
    text += member("version", kValidationReportVersion) + ",\n ";
    text += member("tool", {{"name", "cdprep"}, {"version", run.tool_version}}) + ",\n ";
    text += member("options", options) + ",\n ";
    text += member("baseline", baseline) + ",\n \"meshes\":[\n";
    return text;
}

std::string validation_json_mesh(const ValidationReport& report, const ValidationRun& run) {
    return laid_out(mesh_json(report, run), 0);
}

std::string validation_json_tail(const ValidationTotals& totals) {
    const Json summary = {{"meshes", totals.files},          {"failed", totals.failed},
                          {"unreadable", totals.unreadable}, {"errors", totals.errors},
                          {"warnings", totals.warnings},     {"notes", totals.notes},
                          {"known", totals.known},           {"interrupted", totals.interrupted}};
    return "],\n " + member("summary", summary) + ",\n " + member("exit", totals.exit) + "}\n";
}

std::string baked_findings_json(const ValidationReport& report, const std::string& repair,
                                std::size_t max_places) {
    ValidationRun run;
    run.max_places = max_places;
    Json json = mesh_json(report, run);
    for (const char* name : {"input", "uri", "exit"}) json.erase(name);
    if (!repair.empty()) json["repair"] = Json::parse(repair);
    return compact(json);
}

std::string validation_ndjson(const ValidationReport& report, const ValidationRun& run) {
    return compact(mesh_json(report, run)) + "\n";
}

Json counts_json(const mesh::DefectCounts& counts) {
    Json json = Json::object();
    for (const CountName& entry : kCounts) json[entry.name] = counts.*entry.count;
    return json;
}

}  // namespace cdprep::report
