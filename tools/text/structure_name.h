// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/advanced/structure.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/tetra_tree.h"

namespace cdprep::report {

/// How --structure, --structures, provenance and reports call a structure.
struct StructureName {
    const char* name;
    Structure structure;
    bool is_baked;  ///< --structures may ask for it; the others come of themselves, or with effects
};
inline constexpr std::array<StructureName, 6> kStructureNames = {{
    {"bvh", Structure::bvh, false},
    {"octree", Structure::octree, true},
    {"octree-adaptive", Structure::adaptive_octree, true},
    {"hashed-octree", Structure::hashed_octree, true},
    {"tetra-tree", Structure::tetra_tree, true},
    {"pieces", Structure::pieces, false},
}};

[[nodiscard]] constexpr const char* structure_name(Structure structure) noexcept {
    for (const StructureName& known : kStructureNames) {
        if (known.structure == structure) return known.name;
    }
    return "unknown";
}

/// What to bake so that questions can be asked through it; empty for what every bake has.
[[nodiscard]] constexpr const char* baked_name(Structure structure) noexcept {
    if (structure == Structure::bvh) return "";
    return structure_name(structure);
}

/// As --split and --bounding spell them.
[[nodiscard]] constexpr const char* split_name(format::SplitRule rule) noexcept {
    return rule == format::SplitRule::median ? "median" : "area";
}
/// As --octree-bounding spells it.
[[nodiscard]] constexpr const char* bounding_name(bool has_boxes) noexcept {
    return has_boxes ? "boxes" : "cells";
}
[[nodiscard]] constexpr const char* bounding_name(format::TetraBounding bounding) noexcept {
    if (bounding == format::TetraBounding::boxes) return "boxes";
    return bounding == format::TetraBounding::tetra ? "tetra" : "caps";
}

}  // namespace cdprep::report
