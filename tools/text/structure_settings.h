// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cdprep/advanced/structure.h"

namespace cdprep::report {

/// A choice that a structure has: "split" or "bounding", and what was chosen, as the options
/// spell it.
struct StructureRule {
    std::string name;
    std::string value;
};

/// How a structure was built: all that decides its bytes, besides the mesh.
struct StructureSettings {
    Structure structure = Structure::octree;
    std::uint32_t level = 0;
    std::uint32_t threshold = 0;
    std::vector<StructureRule> rules;
};

}  // namespace cdprep::report
