// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cdprep/advanced/structure.h"

namespace cdprep::report {

/// A choice in the construction of a structure: "split" or "bounding", and the chosen value as
/// the options spell it.
struct StructureRule {
    std::string name;
    std::string value;
};

/// The settings of a structure: with the mesh they determine its bytes.
struct StructureSettings {
    Structure structure = Structure::octree;
    std::uint32_t level = 0;
    std::uint32_t threshold = 0;
    std::vector<StructureRule> rules;
};

}  // namespace cdprep::report
