// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/structure_settings.h"

namespace cdprep::report {

/// Where a bake comes from: everything that decides its bytes, and nothing else
/// (no path, no time, no host).
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
    std::optional<double> max_error;  ///< of parts
    std::uint64_t source_hash = 0;    ///< format::checksum() of the input file
};

/// Canonical JSON: keys sorted, no blanks, shortest numbers.
[[nodiscard]] std::string provenance_json(const Provenance& provenance);

}  // namespace cdprep::report
