// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_report.h"

#include <nlohmann/json.hpp>

#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"
#include "text/space_name.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPointsOfEngines = 255;  ///< of PhysX and Unity

std::string points_text(const ExportReport& report) {
    std::string text = "  " + counted(report.points, "point", "points") + ", of " +
                       std::to_string(report.stored_points) + " in the file";
    if (report.growth > 0)
        text += "; parts grew by at most " + at_most_in_six_digits(report.growth);
    text += "\n";
    if (report.rounding > 0) {
        text += "  corners were rounded to floats, by at most " +
                at_most_in_six_digits(report.rounding) +
                ": the parts may miss the mesh by as much\n";
    }
    if (report.low_points > 0) {
        text += "  " + counted(report.low_points, "point sticks", "points stick") +
                " out so little that engines may ignore " +
                (report.low_points == 1 ? "it\n" : "them\n");
    }
    if (report.most_points > kMostPointsOfEngines) {
        text += "  a part has " + std::to_string(report.most_points) +
                " points, and PhysX and Unity take at most " +
                std::to_string(kMostPointsOfEngines) + "\n";
    }
    return text;
}

std::string visual_text(const ExportReport& report) {
    if (report.is_visual_refused) {
        return "  without the mesh itself: it is not balanced and wound outwards, which MuJoCo "
               "needs\n";
    }
    return report.has_visual ? "  with the mesh itself, without normals and materials\n" : "";
}

/// Returns why the unit is unknown: a --unit that was given does not help if all is normalised.
std::string lack_of_unit(const ExportReport& report) {
    return report.input + (report.is_normalized
                               ? ": was baked with --normalize, so its lengths have no unit"
                               : ": states no unit");
}

std::string how_to_state_it(const ExportReport& report) {
    return std::string("Bake it ") + (report.is_normalized ? "without --normalize and " : "") +
           "with --unit mm, cm, m, in or ft.";
}

}  // namespace

std::string unknown_unit(const ExportReport& report) {
    return lack_of_unit(report) + ", which " + report.output + " needs. " + how_to_state_it(report);
}

std::string unit_warning(const ExportReport& report) {
    if (!report.is_in_metres || report.metres_per_unit > 0) return {};
    return lack_of_unit(report) + "; " + report.output + " takes " +
           (report.is_normalized ? "them" : "it") + " as metres, " +
           size_text(report.size, report.metres_per_unit) +
           (report.mass ? " and " + in_six_digits(*report.mass) + " kg" : std::string()) + ". " +
           how_to_state_it(report);
}

std::string export_text(const ExportReport& report) {
    std::string text =
        printable(report.input) + ": " +
        (report.is_of_whole ? "the convex hull of the whole, because the file has no parts,"
                            : counted(report.parts, "convex part", "convex parts")) +
        " for " + report.engine + " (" + in_six_digits(report.seconds) + " s)\n";
    text += points_text(report);
    text += "  " + std::string(report.is_of_whole ? "it sticks" : "they stick") +
            " out by at most " + at_most_in_six_digits(report.outer_error) + "\n";
    if (report.left_out > 0) {
        text +=
            "  " + counted(report.left_out, "flat part was", "flat parts were") + " not written\n";
    }
    text += visual_text(report);
    if (report.is_in_metres)
        text += "  size " + size_text(report.size, report.metres_per_unit) + "\n";
    if (report.written_up != report.up_axis) {
        text += std::string("  turned: ") + axis_name(report.up_axis) + " is up, written as +" +
                axis_name(report.written_up) + "\n";
    }
    if (report.is_in_metres && report.up_axis == format::UpAxis::unknown) {
        text += "  the axis that is up is unknown: axes are as in the model\n";
    }
    if (report.mass) {
        text += "  mass " + in_six_digits(*report.mass) + " kg, of " +
                cli::text_of(report.mass_of) + "\n";
    }
    return text + "  written to " +
           (report.output == "-" ? "standard output" : printable(report.output)) + "\n";
}

std::string export_json(const ExportReport& report) {
    Json json = {{"input", report.input}, {"exit", report.exit}};
    if (report.error) {
        json["error"] = *report.error;
        return compact(json) + "\n";
    }
    json["output"] = report.output;
    json["engine"] = report.engine;
    json["of"] = report.is_of_whole ? "whole" : "parts";
    json["parts"] = report.parts;
    json["left_out"] = report.left_out;
    json["stored_points"] = report.stored_points;
    json["points"] = report.points;
    json["most_points"] = report.most_points;
    json["low_points"] = report.low_points;
    json["growth"] = report.growth;
    if (report.rounding > 0) json["rounding"] = report.rounding;
    json["outer_error"] = report.outer_error;
    json["visual"] = report.has_visual;
    json["size"] = report.size;
    json["metres_per_unit"] = report.metres_per_unit;
    json["up_axis"] = axis_name(report.up_axis);
    json["written_up"] = axis_name(report.written_up);
    if (report.mass) {
        json["mass"] = *report.mass;
        json["mass_of"] = cli::word_of(report.mass_of);
    }
    json["seconds"] = report.seconds;
    return compact(json) + "\n";
}

}  // namespace cdprep::report
