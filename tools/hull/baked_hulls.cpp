// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/baked_hulls.h"

#include <algorithm>

#include "text/number_text.h"

namespace cdprep::report {
namespace {

using format::Hull;
using format::HullScope;

const char* scope_name(HullScope scope) {
    if (scope == HullScope::whole) return "whole";
    if (scope == HullScope::part) return "part";
    return scope == HullScope::component ? "component" : "instance";
}

bool is_exact(const Hull& hull) {
    return (hull.flags & format::hull_exact) != 0;
}

}  // namespace

nlohmann::ordered_json baked_hulls_json(const Model& model) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Hull& hull : model.hulls().hulls) {
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

std::string baked_hulls_text(const Model& model, std::size_t most_lines) {
    std::string text;
    const auto hulls = model.hulls().hulls;
    for (const Hull& hull : hulls.first(std::min(most_lines, hulls.size()))) {
        text += std::string("  ") + scope_name(hull.scope);
        if (hull.scope != HullScope::whole) text.append(1, ' ').append(std::to_string(hull.number));
        text += ": dimension " + std::to_string(hull.dimension) + ", " +
                std::to_string(hull.point_count) + " points, " + std::to_string(hull.facet_count) +
                " facets in " + std::to_string(hull.group_count) + " faces" +
                (is_exact(hull) ? ", exact\n"
                                : ", enclosing within " + in_six_digits(hull.distance) + "\n");
    }
    if (hulls.size() > most_lines) {
        text += "  and " + std::to_string(hulls.size() - most_lines) + " more\n";
    }
    return text;
}

}  // namespace cdprep::report
