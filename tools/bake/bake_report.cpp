// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

nlohmann::ordered_json to_json(const BakeReport& report) {
    nlohmann::ordered_json json = {
        {"input", report.input}, {"output", report.output}, {"exit", report.exit}};
    if (report.error) {
        json["error"] = *report.error;
        return json;
    }
    json["triangles"] = report.triangles;
    json["vertices"] = report.vertices;
    json["components"] = report.components;
    json["merged_vertices"] = report.merged_vertices;
    json["degenerate_triangles"] = report.degenerate_triangles;
    json["balanced"] = report.balanced;
    if (!report.repaired.empty()) json["repaired"] = report.repaired;
    json["promises"] = report.promises;
    json["warnings"] = report.warnings;
    json["crossings_complete"] = report.crossings_complete;
    if (!report.remarks.empty()) json["remarks"] = report.remarks;
    json["precision"] = report.single_precision ? "f32" : "f64";
    if (!report.structures.empty()) json["structures"] = structures_json(report.structures);
    if (report.parts) {
        json["parts"] = {
            {"count", report.parts->count},
            {"outer_error", report.parts->outer_error},
            {"as_asked", report.parts->is_as_asked},
            {"proof",
             {{"fragments", report.parts->fragments}, {"outside", report.parts->outside}}}};
    }
    json["bytes"] = report.bytes;
    json["seconds"] = report.seconds;
    for (const StageTime& stage : report.stages) json["stages"][stage.stage] = stage.seconds;
    return json;
}

}  // namespace

std::string bake_text(const BakeReport& report, Timings timings) {
    const char* const balance = report.triangles == 0 ? "empty"
                                : report.balanced     ? "balanced"
                                                      : "unbalanced";
    std::string text =
        printable(report.output) + ": " + counted(report.triangles, "triangle", "triangles") +
        ", " + counted(report.vertices, "vertex", "vertices") + ", " + balance + ", " +
        (report.single_precision ? "f32" : "f64") + ", " + counted(report.bytes, "byte", "bytes") +
        ", " + fixed(report.seconds, 3) + " s\n";
    if (report.warnings > 0) {
        text += "  " + std::to_string(report.warnings) +
                (report.warnings == 1 ? " rule finds" : " rules find") +
                " defects; 'cdprep info' lists them\n";
    }
    for (const std::string& remark : report.remarks) text += "  " + remark + "\n";
    text += structures_text(report.structures);
    if (report.parts) {
        text += "  " + std::to_string(report.parts->count) +
                " convex parts enclose the mesh and stick out by at most " +
                at_most_in_six_digits(report.parts->outer_error) +
                (report.parts->is_as_asked ? "\n" : ", so the request is not met\n");
    }
    if (timings == Timings::hide) return text;
    for (const StageTime& stage : report.stages) {
        text += "  " + stage.stage +
                std::string(18 - std::min<std::size_t>(17, stage.stage.size()), ' ') +
                fixed(stage.seconds, 4) + " s\n";
    }
    return text;
}

std::string bake_json(const std::vector<BakeReport>& reports) {
    nlohmann::ordered_json json;
    json["models"] = nlohmann::ordered_json::array();
    for (const BakeReport& report : reports) json["models"].push_back(to_json(report));
    // File names need not be UTF-8; JSON must.
    return indented(json);
}

}  // namespace cdprep::report
