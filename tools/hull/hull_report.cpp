// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/hull_report.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

const char* shape_name(int dimension) {
    constexpr std::array<const char*, 5> kNames = {"nothing", "a point", "a segment", "a polygon",
                                                   "a solid"};
    return kNames.at(static_cast<std::size_t>(dimension) + 1);
}

std::string hull_line(const HullFigures& hull) {
    std::string line = "  " + printable(hull.name) + ": " + shape_name(hull.dimension) + ", " +
                       std::to_string(hull.points) + " points, " + std::to_string(hull.facets) +
                       " facets in " + std::to_string(hull.faces) + " faces";
    line += hull.exact
                ? ", exact"
                : ", at most " + at_most_in_six_digits(hull.distance) + " outside the exact hull";
    return line + "\n";
}

Json json_of(const HullFigures& hull) {
    return {{"name", hull.name},        {"dimension", hull.dimension}, {"points", hull.points},
            {"facets", hull.facets},    {"faces", hull.faces},         {"exact", hull.exact},
            {"distance", hull.distance}};
}

}  // namespace

Error hull_beyond_range(const std::string& input, const char* option) {
    return {ErrorCode::bad_argument, input +
                                         ": an enclosing hull would have coordinates beyond the "
                                         "range of doubles. Leave out " +
                                         option + "."};
}

std::string hull_text(const HullReport& report, std::size_t most_lines) {
    std::string text =
        printable(report.input) + ": " + counted(report.triangles, "triangle", "triangles") + ", " +
        counted(report.vertices, "vertex", "vertices") + "\n" + printable(report.output) + ": " +
        counted(report.hulls.size(), "hull", "hulls") + " per " + report.scope + ", found in " +
        printed(report.seconds, "%.3f") + " s\n";
    for (std::size_t i = 0; i < std::min(most_lines, report.hulls.size()); ++i) {
        text += hull_line(report.hulls[i]);
    }
    if (report.hulls.size() > most_lines) {
        text += "  and " + std::to_string(report.hulls.size() - most_lines) +
                " more; --format json has all\n";
    }
    return text;
}

std::string hull_json(const HullReport& report) {
    Json json = {{"input", report.input}, {"exit", report.exit}};
    if (report.error) {
        json["error"] = *report.error;
        return indented(json);
    }
    json["output"] = report.output;
    json["per"] = report.scope;
    json["triangles"] = report.triangles;
    json["vertices"] = report.vertices;
    json["seconds"] = report.seconds;
    json["hulls"] = Json::array();
    for (const HullFigures& hull : report.hulls) json["hulls"].push_back(json_of(hull));
    return indented(json);
}

}  // namespace cdprep::report
