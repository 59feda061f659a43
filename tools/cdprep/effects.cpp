// SPDX-License-Identifier: GPL-3.0-or-later
#include "effects.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "cdprep/format/sections.h"

namespace cdprep::cli {
namespace {

using format::SectionId;
using format::SectionSet;

constexpr SectionSet kGeometry = {SectionId::positions_f32, SectionId::positions_f64,
                                  SectionId::triangles, SectionId::bvh_nodes,
                                  SectionId::degenerate_bits};
/// What questions about two models need besides.
constexpr SectionSet kPair = {SectionId::bvh_leaves, SectionId::oriented_nodes,
                              SectionId::swept_nodes};
/// Where in the imported file an answer lies.
constexpr SectionSet kSource = {SectionId::source_triangle, SectionId::source_vertex,
                                SectionId::source_face,     SectionId::repaired_from,
                                SectionId::instances,       SectionId::instance_names,
                                SectionId::group_runs,      SectionId::group_names,
                                SectionId::material_runs,   SectionId::material_names};
/// Convex pieces of the surface.
constexpr SectionSet kPieces = {SectionId::pieces,           SectionId::piece_triangles,
                                SectionId::piece_vertices,   SectionId::piece_facets,
                                SectionId::piece_nodes,      SectionId::piece_leaves,
                                SectionId::piece_node_hulls, SectionId::piece_swept};
/// What tells contacts between them.
constexpr SectionSet kContacts = {SectionId::piece_adjacency, SectionId::edge_convexity,
                                  SectionId::triangle_piece};
/// In every bake, whatever it serves.
constexpr SectionSet kAlways = {SectionId::bounds, SectionId::provenance, SectionId::verdicts,
                                SectionId::findings};

struct Effect {
    const char* name;
    SectionSet sections;
};

constexpr SectionSet with(SectionSet a, SectionSet b) {
    a.insert(b);
    return a;
}

constexpr std::array<Effect, 11> kEffects = {{
    {"closest", with(kGeometry, kSource)},
    {"collide", with(with(kGeometry, kPair), {SectionId::components})},
    {"contacts", with(with(with(with(kGeometry, kPair), kSource), kPieces), kContacts)},
    {"distance", with(with(kGeometry, kPair), kSource)},
    {"inaccessible", with(kGeometry, kSource)},
    {"inside", with(kGeometry, {SectionId::components})},
    {"overlap", with(with(kGeometry, kPair), kSource)},
    {"pieces", with(with(with(kGeometry, kPair), kSource), kPieces)},
    {"ray", with(kGeometry, kSource)},
    {"response", {SectionId::mass_properties}},
    {"within", with(with(kGeometry, kPair), kSource)},
}};

const Effect* find_effect(const std::string& name) {
    const auto at = std::find_if(kEffects.begin(), kEffects.end(),
                                 [&](const Effect& effect) { return name == effect.name; });
    return at == kEffects.end() ? nullptr : at;
}

Error unknown_effect(const std::string& name) {
    std::string message = "The effect '" + name + "' cannot be baked; these can:";
    for (const Effect& effect : kEffects) message += std::string(" ") + effect.name;
    return {ErrorCode::bad_argument, message + ", or all."};
}

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> names;
    std::istringstream stream(list);
    for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
    return names;
}

std::vector<std::string> all_names() {
    std::vector<std::string> names;
    names.reserve(kEffects.size());
    for (const Effect& effect : kEffects) names.emplace_back(effect.name);
    return names;
}

void append_name(std::string& names, const char* name) {
    if (!names.empty()) names += ", ";
    names += name;
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
    Effects effects{names, kAlways, all};
    for (const std::string& name : names) {
        const Effect* effect = find_effect(name);
        if (effect == nullptr) return unknown_effect(name);
        effects.sections.insert(effect->sections);
    }
    return effects;
}

SectionSet sections_for(const std::string& effect) {
    const Effect* found = find_effect(effect);
    return found == nullptr ? SectionSet{} : found->sections;
}

std::string missing_sections(SectionSet needed, SectionSet present) {
    // Only one kind of positions is in a file, and some sections are absent when
    // they would say nothing.
    constexpr std::array<SectionId, 7> kDemanded = {
        SectionId::triangles,       SectionId::bvh_nodes,  SectionId::bvh_leaves,
        SectionId::source_triangle, SectionId::components, SectionId::pieces,
        SectionId::triangle_piece};
    std::string names;
    if (needed.contains(SectionId::positions_f32) && !present.contains(SectionId::positions_f32) &&
        !present.contains(SectionId::positions_f64)) {
        append_name(names, "positions");
    }
    for (const SectionId id : kDemanded) {
        if (needed.contains(id) && !present.contains(id)) {
            append_name(names, format::section_name(id));
        }
    }
    return names;
}

std::string missing_parts(SectionSet needed, SectionSet present) {
    std::string names;
    for (std::uint32_t number = 0; number < 64; ++number) {
        const SectionId id{number};
        if (needed.contains(id) && !present.contains(id)) {
            append_name(names, format::section_name(id));
        }
    }
    return names;
}

}  // namespace cdprep::cli
