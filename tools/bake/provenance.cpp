// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/provenance.h"

#include <nlohmann/json.hpp>

#include "text/bounds_name.h"
#include "text/number_text.h"
#include "text/space_name.h"
#include "text/structure_name.h"

namespace cdprep::cli {
namespace {

/// Returns {} if no structure besides the BVH was built.
nlohmann::json structures_json(const std::vector<report::StructureSettings>& structures) {
    nlohmann::json json = nlohmann::json::object();
    for (const report::StructureSettings& settings : structures) {
        nlohmann::json& own = json[report::structure_name(settings.structure)];
        own = {{"level", settings.level}, {"threshold", settings.threshold}};
        for (const report::StructureRule& rule : settings.rules) own[rule.name] = rule.value;
    }
    return json;
}

}  // namespace

std::string provenance_json(const BakeOptions& options, const mesh::TriangleSoup& soup) {
    const HullChoice& hulls = options.structures.hulls;
    nlohmann::json json = {
        {"tool", {{"name", "cdprep"}, {"version", CDPREP_VERSION}}},
        // Raise a stage's number when its result for the same input changes.
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
         {{"bounds", report::bounds_name(options.bounds)},
          {"effects", options.effects.names},
          {"hulls", options.structures.has_hulls()},
          {"normalize", options.normalize},
          {"piece_tolerance", options.piece_tolerance},
          {"repair", options.repair},
          {"structures", structures_json(options.structures.settings)},
          {"weld", options.weld_distance}}},
        {"source", {{"xxh3_64", report::hexadecimal(soup.source_hash)}}},
    };
    nlohmann::json& given = json["options"];
    if (hulls.max_vertices > 0) given["hull_vertices"] = hulls.max_vertices;
    if (hulls.parts) given["parts"] = *hulls.parts;
    if (hulls.max_error) given["max_error"] = *hulls.max_error;
    if (options.max_pairs != mesh::kDefaultMaxPairs) given["max_pairs"] = options.max_pairs;
    if (options.import.metres_per_unit) given["metres_per_unit"] = *options.import.metres_per_unit;
    if (options.import.up_axis) given["up_axis"] = report::axis_name(*options.import.up_axis);
    if (!options.part.empty()) json["source"]["part"] = options.part;
    for (const mesh::InputFile& file : soup.other_files) {
        json["source"]["files"].push_back(
            {{"name", file.name}, {"xxh3_64", report::hexadecimal(file.hash)}});
    }
    return json.dump();
}

}  // namespace cdprep::cli
