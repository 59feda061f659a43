// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/effects.h"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "text/nearest_word.h"

namespace cdprep::cli {
namespace {

using format::SectionId;
using format::SectionSet;

/// The word for every effect.
constexpr const char* kAll = "all";

/// The sections of every baked file, whatever its effects.
constexpr SectionSet kAlways = {SectionId::bounds, SectionId::provenance, SectionId::verdicts,
                                SectionId::findings};

/// The effects whose queries measure.
constexpr Ask kMeasures =
    Ask::distance | Ask::within | Ask::contacts | Ask::response | Ask::continuous | Ask::haptic;

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

/// Returns the row that the option of a row names: that of collide for solid.
const Needs& row_of_option(const Needs& row) {
    const std::string_view option = row.bake_option;
    return *find_needs(option.substr(option.rfind(' ') + 1));
}

/// Returns the sections of a bake for one row alone.
SectionSet baked_for(const Needs& row) {
    SectionSet sections = sections_for(row.ask);
    if (is_effect(row)) sections.erase(sections_of_structures());
    if ((row.ask & kMeasures) == Ask::nothing) sections.erase(SectionId::swept_nodes);
    return sections;
}

SectionSet common(SectionSet a, SectionSet b) {
    SectionSet only_a = a;
    only_a.erase(b);
    a.erase(only_a);
    return a;
}

Error unknown_effect(const std::string& name) {
    std::string list;
    for (const std::string& known : all_names()) list += known + ", ";
    return {ErrorCode::bad_argument, "--effects: unknown effect '" + name + "'. Choose from " +
                                         list + "or all." + report::suggestion(name, all_names())};
}

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> names;
    std::istringstream stream(list);
    for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
    return names;
}

}  // namespace

std::vector<std::string> effect_words() {
    std::vector<std::string> words = all_names();
    words.emplace_back(kAll);
    return words;
}

Result<Effects> parse_effects(const std::string& list) {
    std::vector<std::string> names = split(list.empty() ? kDefaultEffects : list);
    const bool all = std::find(names.begin(), names.end(), kAll) != names.end();
    if (all) {
        std::erase(names, kAll);
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

std::string options_to_bake(Ask needed, Ask served, SectionSet sections) {
    Ask named = Ask::nothing, asks = Ask::nothing;
    for (const Needs& row : needs()) {
        if (contains(needed, row.ask)) named = named | row_of_option(row).ask;
        if (contains(needed | served, row.ask)) asks = asks | row_of_option(row).ask;
    }
    // From the last row on, so that distance is named rather than haptic.
    for (std::size_t i = needs().size(); i-- > 0;) {
        const Needs& row = needs()[i];
        if (contains(named, row.ask)) continue;
        SectionSet others;
        for (const Needs& other : needs()) {
            if (contains(without(asks, row.ask), other.ask)) others.insert(baked_for(other));
        }
        if (others.contains(common(baked_for(row), sections))) asks = without(asks, row.ask);
    }
    std::string effects, structures;
    for (const Needs& row : needs()) {
        if (!contains(asks, row.ask)) continue;
        std::string& list = is_effect(row) ? effects : structures;
        list += list.empty() ? row.bake_option : std::string(",") + row.name;
    }
    return effects + (effects.empty() || structures.empty() ? "" : " ") + structures;
}

build::BvhBounds bounds_for(const Effects& effects) {
    const bool measures = (effects.asks & kMeasures) != Ask::nothing;
    return measures ? build::BvhBounds::oriented_and_swept : build::BvhBounds::oriented;
}

}  // namespace cdprep::cli
