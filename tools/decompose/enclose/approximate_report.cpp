// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/approximate_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"
#include "text/space_name.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

std::size_t most_vertices(const convex::ApproximateParts& result) {
    std::size_t most = 0;
    for (const auto& part : result.parts) most = std::max(most, part.hull.points.size());
    return most;
}

Json table_json(const ApproximateReport& report) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < report.result.parts.size(); ++i) {
        const convex::ApproximatePart& part = report.result.parts[i];
        Json row = {{"part", i},
                    {"vertices", part.hull.points.size()},
                    {"facets", part.hull.facets.size()},
                    {"triangles", part.triangles.size()},
                    {"outer_error", part.error.upper}};
        if (part.node < report.node_names.size() && !report.node_names[part.node].empty()) {
            row["node"] = report.node_names[part.node];
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

bool is_turned(const ApproximateReport& report) {
    return report.is_for_simulators &&
           (report.up_axis == format::UpAxis::x || report.up_axis == format::UpAxis::y);
}

}  // namespace

std::string unit_warning(const ApproximateReport& report) {
    if (!report.is_for_simulators || report.metres_per_unit > 0) return {};
    return report.input +
           (report.is_normalized ? ": has no unit after --normalize; " : ": states no unit; ") +
           report.output + " takes it as metres, " +
           size_text(report.size, report.metres_per_unit) +
           (report.mass ? " and " + in_six_digits(*report.mass) + " kg" : std::string()) +
           (report.is_normalized ? ". Leave out --normalize." : ". Give --unit.");
}

std::string approximate_text(const ApproximateReport& report) {
    const convex::ApproximateParts& result = report.result;
    const double share = report.diagonal > 0 ? 100 * result.outer_error / report.diagonal : 0;
    std::string text = printable(report.input) + ": " +
                       counted(result.parts.size(), "convex part", "convex parts") + " enclose " +
                       counted(report.triangles, "triangle", "triangles") + " (" +
                       in_six_digits(report.seconds) + " s)\n";
    text += "  they stick out of the ";
    text += report.to_surface ? "surface" : "solid";
    text += " by at most " + at_most_in_six_digits(result.outer_error) + " (" +
            at_most_in_six_digits(share) + " % of the diagonal; at least " +
            at_least_in_six_digits(result.outer_lower) + ")\n";
    text += "  proof of enclosure: " + std::to_string(result.proof.fragments) + " fragments, " +
            std::to_string(result.proof.outside) + " corners outside their hulls\n";
    text += "  at most " + counted(most_vertices(result), "vertex", "vertices") + " per part\n";
    if (!report.to_surface && report.unbalanced_components > 0) {
        text += "  " +
                counted(report.unbalanced_components,
                        "component is not balanced and counts as a surface",
                        "components are not balanced and count as surfaces") +
                "; 'cdprep repair --preset closed' can make them balanced\n";
    }
    if (result.ran_out_of_work)
        text += "  the search budget was used up: a larger --work can give a tighter result\n";
    if (report.is_missed_by_rounding) {
        text +=
            "  the request is not met, because corners were rounded: write OBJ or permit a "
            "larger error\n";
    } else if (!result.is_as_asked) {
        text += "  the request is not met: it needs more parts or a larger error\n";
    }
    if (report.left_out > 0) {
        text += "  " + std::to_string(report.left_out) + " flat parts were not written\n";
    }
    if (report.rounding > 0) {
        text += "  corners were rounded to floats, by at most " +
                at_most_in_six_digits(report.rounding) +
                ": the parts may miss the mesh by as much, which the errors include\n";
    }
    if (report.is_for_simulators)
        text += "  size " + size_text(report.size, report.metres_per_unit) + "\n";
    if (is_turned(report)) {
        text += std::string("  turned: ") + axis_name(report.up_axis) + " is up, written as +z\n";
    }
    if (report.mass) {
        text += "  mass " + in_six_digits(*report.mass) + " kg, of " +
                cli::text_of(report.mass_of) + "\n";
    }
    if (!report.output.empty()) text += "  written to " + printable(report.output) + "\n";
    if (!report.has_table) return text;
    text += "  part vertices facets triangles outer_error\n";
    for (std::size_t i = 0; i < result.parts.size(); ++i) {
        const convex::ApproximatePart& part = result.parts[i];
        text += "  " + std::to_string(i) + " " + std::to_string(part.hull.points.size()) + " " +
                std::to_string(part.hull.facets.size()) + " " +
                std::to_string(part.triangles.size()) + " " +
                at_most_in_six_digits(part.error.upper) + "\n";
    }
    return text;
}

std::string approximate_json(const ApproximateReport& report) {
    Json json = {{"input", report.input}, {"output", report.output}, {"exit", report.exit}};
    if (report.error) {
        json["error"] = *report.error;
    } else {
        const convex::ApproximateParts& result = report.result;
        json["method"] = "approximate";
        if (report.max_error) json["max_error"] = *report.max_error;
        if (report.max_parts) json["max_parts"] = *report.max_parts;
        json["triangles"] = report.triangles;
        json["parts"] = result.parts.size();
        json["outer_error"] = result.outer_error;
        json["outer_error_at_least"] = result.outer_lower;
        json["inner_error"] = result.inner_error;
        json["measured_to"] = report.to_surface ? "surface" : "solid";
        json["unbalanced_components"] = report.unbalanced_components;
        json["diagonal"] = report.diagonal;
        json["size"] = report.size;
        json["metres_per_unit"] = report.metres_per_unit;
        json["up_axis"] = axis_name(report.up_axis);
        json["proof"] = {{"triangles", result.proof.triangles},
                         {"fragments", result.proof.fragments},
                         {"tests", result.proof.tests},
                         {"outside", result.proof.outside}};
        json["most_vertices"] = most_vertices(result);
        json["as_asked"] = result.is_as_asked;
        json["ran_out_of_work"] = result.ran_out_of_work;
        json["left_out"] = report.left_out;
        if (report.rounding > 0) json["rounding"] = report.rounding;
        if (report.mass) {
            json["mass"] = *report.mass;
            json["mass_of"] = cli::word_of(report.mass_of);
        }
        json["seconds"] = report.seconds;
        if (report.has_table) json["table"] = table_json(report);
    }
    return compact(json) + "\n";
}

}  // namespace cdprep::report
