// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "crossings/self_intersections.h"
#include "text/structure_settings.h"

namespace cdprep::report {

/// Where a bake comes from: everything that decides its bytes, and nothing else
/// (no time, no host, no path but those by which the input refers to others).
struct Provenance {
    std::string tool_version;
    std::vector<std::string> effects;  ///< sorted
    bool normalize = false;
    double weld_distance = 0;
    std::string repair;  ///< the preset, or empty
    double piece_tolerance = 0;
    std::string bounds;  ///< as --bounds spells it
    std::vector<StructureSettings> structures;
    bool has_hulls = false;
    std::uint32_t hull_vertices = 0;  ///< 0: exact hulls
    std::optional<std::size_t> parts;
    std::optional<double> max_error;                   ///< of parts
    std::optional<double> metres_per_unit;             ///< given, in place of what the file says
    std::optional<format::UpAxis> up_axis;             ///< likewise
    std::uint64_t max_pairs = mesh::kDefaultMaxPairs;  ///< that end the search for crossings
    std::uint64_t source_hash = 0;                     ///< format::checksum() of the input file
    std::vector<mesh::InputFile> other_files;          ///< that it refers to and that were read
};

/// Canonical JSON: keys sorted, no blanks, shortest numbers.
[[nodiscard]] std::string provenance_json(const Provenance& provenance);

}  // namespace cdprep::report
