// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/format/octree.h"
#include "cdprep/format/tetra_tree.h"

namespace cdprep::build {

/// The limits at which a structure stops dividing space.
struct TreeLimits {
    std::uint32_t level;      ///< no node is deeper
    std::uint32_t threshold;  ///< a node with fewer triangles is not divided
};

/// Settings for all structures, chosen together. If a file has a hashed octree, its cells also
/// serve as the plain octree.
struct StructurePreset {
    const char* name;
    TreeLimits octree;
    TreeLimits hashed_octree;
    TreeLimits adaptive_octree;
    TreeLimits tetra_tree;
    format::SplitRule split;         ///< of the adaptive octree
    bool boxes;                      ///< whether octree cells have boxes around their contents
    format::TetraBounding bounding;  ///< of the tetra-tree
};

/// The settings of the published studies in docs/STUDIES.md: 512 cells each. That is 8^3 for the
/// octree and 8 * 4^3 for the tetra-tree.
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

/// The fastest settings for overlaps and collisions. Cells are small enough to be separated by the
/// boxes around their contents, and no smaller. The lists of two cells that meet are compared in
/// clusters of up to 64 triangles. More cells would compare the same clusters again. The table
/// gives times relative to the BVH, as medians over twelve pairs of models. The first number of an
/// entry is for light poses, the second for deep ones
/// (tests/bench/results/xeon_avx512/structure_queries.csv):
///
///                      octree       adaptive     hashed       tetra-tree
///     tuned, collide   2.4, 2.5     2.3, 2.7     5.6, 5.3     3.6, 3.9
///     tuned, overlap   2.1, 2.3     2.1, 2.2     2.3, 2.2     2.8, 2.7
///     paper, collide   7.4, 6.5     12, 6.6      18, 19       18, 11
///     paper, overlap   3.2, 2.3     5.7, 4.0     7.0, 8.5     6.4, 4.9
///
/// For containment of points, a deeper tetra-tree is better: a query's cost grows with the number
/// of triangles in one cone.
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
