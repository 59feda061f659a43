// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/effects.h"
#include "text/nearest_word.h"

#include <algorithm>
#include <sstream>

namespace cdprep::cli {
namespace {

using format::SectionId;
using format::SectionSet;

/// The sections of every baked file, whatever its effects.
constexpr SectionSet kAlways = {SectionId::bounds, SectionId::provenance, SectionId::verdicts,
                                SectionId::findings};

bool is_effect(const Needs& row) {
    return row.bake_option == std::string("--effects ") + row.name;
}

/// Returns the names of all effects, sorted.
std::vector<std::string> all_names() {
    std::vector<std::string> names;
    for (const Needs& row : needs()) {
        if (is_effect(row)) names.emplace_back(row.name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// Returns the sections of all structures. `--structures` chooses these, even where an effect
/// needs one.
SectionSet sections_of_structures() {
    Ask structures = Ask::nothing;
    for (const Needs& row : needs()) {
        const bool is_structure = row.bake_option == std::string("--structures ") + row.name;
        if (is_structure) structures = structures | row.ask;
    }
    return sections_for(structures);
}

Error unknown_effect(const std::string& name) {
    std::string message = "--effects: unknown effect '" + name + "'. Choose from";
    for (const std::string& known : all_names()) message += " " + known + ",";
    return {ErrorCode::bad_argument, message + " or all." + report::suggestion(name, all_names())};
}

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> names;
    std::istringstream stream(list);
    for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
    return names;
}

}  // namespace

Result<Effects> parse_effects(const std::string& list) {
    std::vector<std::string> names = split(list);
    if (names.empty()) names = {"collide", "overlap", "distance", "within", "ray", "closest"};
    const bool all = std::find(names.begin(), names.end(), "all") != names.end();
    if (all) {
        std::erase(names, "all");
        for (const std::string& name : all_names()) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    Effects effects{names, Ask::nothing, {}, all};
    for (const std::string& name : names) {
        const Needs* row = find_needs(std::string_view(name));
        if (row == nullptr || !is_effect(*row)) return unknown_effect(name);
        effects.asks = effects.asks | row->ask;
    }
    effects.sections = sections_for(effects.asks);
    effects.sections.erase(sections_of_structures());
    effects.sections.insert(kAlways);
    return effects;
}

build::BvhBounds bounds_for(const Effects& effects) {
    const bool measures =
        std::any_of(effects.names.begin(), effects.names.end(), [](const std::string& name) {
            return name == "distance" || name == "within" || name == "contacts" ||
                   name == "continuous" || name == "haptic";
        });
    return measures ? build::BvhBounds::oriented_and_swept : build::BvhBounds::oriented;
}

}  // namespace cdprep::cli
