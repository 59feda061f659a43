// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace cdprep::build {

/// How far a structure divides space.
struct TreeLimits {
    std::uint32_t level;      ///< no node is deeper
    std::uint32_t threshold;  ///< a node with fewer triangles is not divided
};

/// Settings for each structure, found together. The hashed octree is the octree's, with
/// tables.
struct StructurePreset {
    const char* name;
    TreeLimits octree;
    TreeLimits adaptive_octree;
    TreeLimits tetra_tree;
};

/// As in the papers: 512 cells each, 8^3 of the octree and 8 * 4^3 of the tetra-tree.
/// Small, quick to build, and slow to ask about large models: a leaf holds a hundred to
/// thousands of triangles.
inline constexpr StructurePreset kPaperPreset = {"paper", {3, 1}, {3, 1}, {3, 1}};

/// What answers soonest.
inline constexpr StructurePreset kTunedPreset = {"tuned", {9, 12}, {9, 12}, {6, 32}};

inline constexpr std::array<StructurePreset, 2> kStructurePresets = {kPaperPreset, kTunedPreset};

}  // namespace cdprep::build
