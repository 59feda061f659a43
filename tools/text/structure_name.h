// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/advanced/structure.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/tetra_tree.h"

namespace cdprep::report {

/// The name of a structure, as --structure, --structures, provenance and reports spell it.
struct StructureName {
    const char* name;
    Structure structure;
    bool is_baked;  ///< --structures may name it; others are always baked or come with effects
};
inline constexpr std::array<StructureName, 6> kStructureNames = {{
    {"bvh", Structure::bvh, false},
    {"octree", Structure::octree, true},
    {"octree-adaptive", Structure::adaptive_octree, true},
    {"hashed-octree", Structure::hashed_octree, true},
    {"tetra-tree", Structure::tetra_tree, true},
    {"pieces", Structure::pieces, false},
}};

/// Convex hulls are no tree, but --structures and --structure name them too.
inline constexpr const char* kHullName = "hull";

[[nodiscard]] constexpr const char* structure_name(Structure structure) noexcept {
    for (const StructureName& known : kStructureNames) {
        if (known.structure == structure) return known.name;
    }
    return "unknown";
}

/// Returns the name of a split rule, as --split spells it.
[[nodiscard]] constexpr const char* split_name(format::SplitRule rule) noexcept {
    return rule == format::SplitRule::median ? "median" : "area";
}
/// Returns the bounding of an octree, as --octree-bounding spells it.
[[nodiscard]] constexpr const char* bounding_name(bool has_boxes) noexcept {
    return has_boxes ? "boxes" : "cells";
}
[[nodiscard]] constexpr const char* bounding_name(format::TetraBounding bounding) noexcept {
    if (bounding == format::TetraBounding::boxes) return "boxes";
    return bounding == format::TetraBounding::tetra ? "tetra" : "caps";
}

}  // namespace cdprep::report
