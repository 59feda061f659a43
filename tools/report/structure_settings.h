// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "cdprep/structure.h"

namespace cdprep::report {

/// How a structure was built: all that decides its bytes, besides the mesh.
struct StructureSettings {
    Structure structure = Structure::octree;
    std::uint32_t level = 0;
    std::uint32_t threshold = 0;
    std::string rule;        ///< "split" or "bounding", where the structure has that option
    std::string rule_value;  ///< as --split or --bounding spells it
};

}  // namespace cdprep::report
