// SPDX-License-Identifier: GPL-3.0-or-later
#include "info/info_report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cdprep/format/sections.h"
#include "text/bounds_name.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"
#include "text/space_name.h"
#include "text/structure_report.h"
#include "text/verdict_words.h"

namespace cdprep::report {
namespace {

std::uint64_t byte_count(const format::SectionEntry& entry) {
    return entry.count * entry.element_size;
}

const char* precision(const Model& model) {
    return model.mesh().positions_f64.empty() ? "f32" : "f64";
}

bool is_normalized(const Model& model) {
    return (model.header().flags & format::model_normalized) != 0;
}

/// Returns the provenance as JSON, or as text if it is not valid JSON.
nlohmann::ordered_json provenance(const Model& model) {
    auto json = parsed(model.record().provenance);
    if (json.is_discarded()) return std::string(model.record().provenance);
    return json;
}

/// Returns the stored findings, with the counts of each rule. Returns null if the file has none, or
/// if they are not a JSON object.
nlohmann::ordered_json findings(const Model& model) {
    auto json = parsed(model.record().findings);
    return json.is_object() ? json : nlohmann::ordered_json();
}

/// Returns a line of findings_text(), or nothing for another form than bake writes.
std::string finding_text(const nlohmann::ordered_json& finding) {
    const auto text_of = [&](const char* key) {
        const auto at = finding.find(key);
        return at != finding.end() && at->is_string() ? printable(at->get<std::string>()) : "?";
    };
    if (!finding.is_object()) return {};
    const auto count = finding.find("count");
    const bool has_count = count != finding.end() && count->is_number_unsigned();
    return "  " + text_of("rule") + " " + text_of("name") + ": " +
           (has_count ? std::to_string(count->get<std::uint64_t>()) : "?") + "\n";
}

/// Returns one line per rule: "  CDP0501 crossing-triangles: 12".
std::string findings_text(const Model& model) {
    const nlohmann::ordered_json found = findings(model);
    if (!found.contains("findings") || !found["findings"].is_array()) return {};
    std::string text;
    for (const auto& finding : found["findings"]) text += finding_text(finding);
    return text.empty() ? "findings: none\n" : "findings:\n" + text;
}

/// Returns the names of the queries and structures that the model serves.
std::vector<std::string> served_names(const Model& model) {
    std::vector<std::string> names;
    for (const Needs& row : needs()) {
        if (model.serves(row.ask)) names.emplace_back(row.name);
    }
    return names;
}

std::string served_text(const Model& model) {
    std::string text = "serves:";
    for (const std::string& name : served_names(model)) text += " " + name;
    return text + "\n";
}

std::string mesh_text(const Model& model) {
    if (model.record().verdicts.empty()) return {};
    const format::Verdict& verdict = model.record().verdicts[0];
    std::string text = "mesh: " + verdict_text(verdict) + "\n";
    text += "promises: " + promises_text(verdict) + "\n";
    if (!model.source().repaired_from.empty()) {
        text += "repaired: source numbers are those of the repaired mesh\n";
    }
    return text + findings_text(model);
}

const char* scope_name(format::HullScope scope) {
    if (scope == format::HullScope::whole) return "whole";
    if (scope == format::HullScope::part) return "part";
    return scope == format::HullScope::component ? "component" : "instance";
}

bool is_exact(const format::Hull& hull) {
    return (hull.flags & format::hull_exact) != 0;
}

/// Returns a JSON array with one object per hull of an open model.
nlohmann::ordered_json baked_hulls_json(const Model& model) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const format::Hull& hull : model.hulls().hulls) {
        json.push_back({{"around", scope_name(hull.scope)},
                        {"number", hull.number},
                        {"dimension", hull.dimension},
                        {"points", hull.point_count},
                        {"facets", hull.facet_count},
                        {"faces", hull.group_count},
                        {"exact", is_exact(hull)},
                        {"distance", hull.distance}});
    }
    return json;
}

/// Returns one indented line per hull for people, at most `most_lines`. Empty without hulls.
std::string baked_hulls_text(const Model& model, std::size_t most_lines) {
    std::string text;
    const auto hulls = model.hulls().hulls;
    for (const format::Hull& hull : hulls.first(std::min(most_lines, hulls.size()))) {
        text += std::string("  ") + scope_name(hull.scope);
        if (hull.scope != format::HullScope::whole) text += " " + std::to_string(hull.number);
        const char* const inner = hull.scope == format::HullScope::part ? "mesh" : "exact hull";
        text += ": dimension " + std::to_string(hull.dimension) + ", " +
                std::to_string(hull.point_count) + " points, " + std::to_string(hull.facet_count) +
                " facets in " + std::to_string(hull.group_count) + " faces" +
                (is_exact(hull) ? ", exact\n"
                                : ", at most " + at_most_in_six_digits(hull.distance) +
                                      " outside the " + inner + "\n");
    }
    if (hulls.size() > most_lines) {
        text += "  and " + std::to_string(hulls.size() - most_lines) + " more\n";
    }
    return text;
}

}  // namespace

std::string info_text(const std::string& file, const Model& model,
                      std::span<const format::SectionEntry> sections) {
    std::string text = printable(file) + ": format " + std::to_string(model.header().version) +
                       ", " + counted(model.triangle_count(), "triangle", "triangles") + ", " +
                       counted(model.vertex_count(), "vertex", "vertices") + ", " +
                       counted(model.record().components.size(), "component", "components") + "\n";
    text += "unit: " + unit_name(model.header().metres_per_unit) +
            ", up axis: " + axis_name(model.header().up_axis) + "\n";
    text += std::string("surface queries: exact; positions ") + precision(model) + "\n";
    if (model.triangle_count() == 0) {
        text += "solid queries: nothing is inside, because there are no triangles\n";
    } else {
        text += model.is_balanced() ? "solid queries: exact, because the mesh is balanced\n"
                                    : "solid queries: unknown, because the mesh is unbalanced\n";
    }
    text += std::string("pair queries: bounded by ") + bounds_name(bounds_of(model)) + "\n";
    text += served_text(model);
    text += mesh_text(model);
    if (const std::string others = structures_text(structure_reports(model)); !others.empty()) {
        text += "structures:\n" + others;
    }
    if (!model.hulls().hulls.empty()) {
        constexpr std::size_t kMostLines = 10;
        text += "hulls:\n" + baked_hulls_text(model, kMostLines);
    }
    text += "section                          offset        bytes\n";
    for (const format::SectionEntry& entry : sections) {
        std::array<char, 128> line{};
        std::snprintf(line.data(), line.size(), "%-26s %12llu %12llu\n",
                      format::section_name(entry.id), static_cast<unsigned long long>(entry.offset),
                      static_cast<unsigned long long>(byte_count(entry)));
        text += line.data();
    }
    return text;
}

std::string info_json(const std::string& file, const Model& model,
                      std::span<const format::SectionEntry> sections) {
    nlohmann::ordered_json json = {
        {"file", file},
        {"format", model.header().version},
        {"bytes", model.header().file_size},
        {"triangles", model.triangle_count()},
        {"vertices", model.vertex_count()},
        {"components", model.record().components.size()},
        {"precision", precision(model)},
        {"balanced", model.is_balanced()},
        {"normalized", is_normalized(model)},
        {"metres_per_unit", model.header().metres_per_unit},
        {"up_axis", axis_name(model.header().up_axis)},
        {"bounds", bounds_name(bounds_of(model))},
        {"serves", served_names(model)},
        {"guarantees",
         {{"surface", "exact"}, {"solid", model.is_balanced() ? "exact" : "unknown"}}},
    };
    if (!model.record().verdicts.empty()) {
        json["facts"] = fact_words(model.record().verdicts[0]);
        json["promises"] = promise_words(model.record().verdicts[0]);
    }
    if (const auto found = findings(model); !found.is_null()) json["found"] = found;
    if (const auto others = structure_reports(model); !others.empty()) {
        json["structures"] = structures_json(others);
    }
    if (!model.hulls().hulls.empty()) json["hulls"] = baked_hulls_json(model);
    json["sections"] = nlohmann::ordered_json::array();
    for (const format::SectionEntry& entry : sections) {
        json["sections"].push_back({{"name", format::section_name(entry.id)},
                                    {"id", static_cast<std::uint32_t>(entry.id)},
                                    {"offset", entry.offset},
                                    {"bytes", byte_count(entry)},
                                    {"count", entry.count}});
    }
    json["provenance"] = provenance(model);
    // File names need not be UTF-8; JSON must.
    return indented(json);
}

}  // namespace cdprep::report
