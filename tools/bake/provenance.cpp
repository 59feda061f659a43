// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/provenance.h"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "text/space_name.h"
#include "text/structure_name.h"

namespace cdprep::report {
namespace {

std::string hexadecimal(std::uint64_t value) {
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
    return text.data();
}

/// {} when nothing besides the hierarchy of boxes was built.
nlohmann::json structures_json(const std::vector<StructureSettings>& structures) {
    nlohmann::json json = nlohmann::json::object();
    for (const StructureSettings& settings : structures) {
        nlohmann::json& own = json[structure_name(settings.structure)];
        own = {{"level", settings.level}, {"threshold", settings.threshold}};
        for (const StructureRule& rule : settings.rules) own[rule.name] = rule.value;
    }
    return json;
}

}  // namespace

std::string provenance_json(const Provenance& provenance) {
    nlohmann::json json = {
        {"tool", {{"name", "cdprep"}, {"version", provenance.tool_version}}},
        // Raised whenever a stage gives other bytes for the same input.
        {"algorithms",
         {{"bvh", 1},
          {"weld", 1},
          {"topology", 1},
          {"bounds", 1},
          {"mass", 1},
          {"defects", 1},
          {"repair", 1},
          {"octree", 1},
          {"octree-adaptive", 1},
          {"tetra-tree", 1},
          {"hull", 1},
          {"pieces", 1},
          {"contacts", 1}}},
        {"options",
         {{"bounds", provenance.bounds},
          {"effects", provenance.effects},
          {"hulls", provenance.has_hulls},
          {"normalize", provenance.normalize},
          {"piece_tolerance", provenance.piece_tolerance},
          {"repair", provenance.repair},
          {"structures", structures_json(provenance.structures)},
          {"weld", provenance.weld_distance}}},
        {"source", {{"xxh3_64", hexadecimal(provenance.source_hash)}}},
    };
    nlohmann::json& options = json["options"];
    if (provenance.hull_vertices > 0) options["hull_vertices"] = provenance.hull_vertices;
    if (provenance.parts) options["parts"] = *provenance.parts;
    if (provenance.max_error) options["max_error"] = *provenance.max_error;
    if (provenance.max_pairs != mesh::kDefaultMaxPairs) options["max_pairs"] = provenance.max_pairs;
    if (provenance.metres_per_unit) options["metres_per_unit"] = *provenance.metres_per_unit;
    if (provenance.up_axis) options["up_axis"] = axis_name(*provenance.up_axis);
    for (const mesh::InputFile& file : provenance.other_files) {
        json["source"]["files"].push_back(
            {{"name", file.name}, {"xxh3_64", hexadecimal(file.hash)}});
    }
    return json.dump();
}

}  // namespace cdprep::report
