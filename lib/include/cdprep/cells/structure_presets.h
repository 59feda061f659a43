// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/format/octree.h"
#include "cdprep/format/tetra_tree.h"

namespace cdprep::build {

/// How far a structure divides space.
struct TreeLimits {
    std::uint32_t level;      ///< no node is deeper
    std::uint32_t threshold;  ///< a node with fewer triangles is not divided
};

/// Settings for each structure, found together. In a file that has a hashed octree, the
/// octree is that one, with tables.
struct StructurePreset {
    const char* name;
    TreeLimits octree;
    TreeLimits hashed_octree;
    TreeLimits adaptive_octree;
    TreeLimits tetra_tree;
    format::SplitRule split;         ///< of the adaptive octree
    bool boxes;                      ///< whether octrees' cells get boxes around what they hold
    format::TetraBounding bounding;  ///< of the tetra-tree
};

/// As in the papers: 512 cells each, 8^3 of the octree and 8 * 4^3 of the tetra-tree.
inline constexpr StructurePreset kPaperPreset = {
    .name = "paper",
    .octree = {3, 1},
    .hashed_octree = {3, 1},
    .adaptive_octree = {3, 1},
    .tetra_tree = {3, 1},
    .split = format::SplitRule::median,
    .boxes = false,
    .bounding = format::TetraBounding::caps,
};

/// What finds overlaps and collisions soonest: cells that are small enough to be told apart by
/// the boxes around what they hold, and no smaller, since what two cells that meet list is held
/// against each other by blocks of 64 triangles, and many cells bring the same blocks again.
/// Times the hierarchy of boxes, medians of light and deep poses of twelve pairs of models
/// (tests/bench/results, structure_queries.csv):
///
///                      octree       adaptive     hashed       tetra-tree
///     tuned, collide   2.4, 2.5     2.3, 2.7     5.6, 5.3     3.6, 3.9
///     tuned, overlap   2.1, 2.3     2.1, 2.2     2.3, 2.2     2.8, 2.7
///     paper, collide   7.4, 6.5     12, 6.6      18, 19       18, 11
///     paper, overlap   3.2, 2.3     5.7, 4.0     7.0, 8.5     6.4, 4.9
///
/// To ask what is inside, a deeper tetra-tree is better: its costs are the triangles of one cone.
inline constexpr StructurePreset kTunedPreset = {
    .name = "tuned",
    .octree = {5, 8},
    .hashed_octree = {6, 32},
    .adaptive_octree = {4, 16},
    .tetra_tree = {3, 64},
    .split = format::SplitRule::surface_area,
    .boxes = true,
    .bounding = format::TetraBounding::boxes,
};

inline constexpr std::array<StructurePreset, 2> kStructurePresets = {kPaperPreset, kTunedPreset};

}  // namespace cdprep::build
