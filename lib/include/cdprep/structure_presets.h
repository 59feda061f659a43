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
inline constexpr StructurePreset kPaperPreset = {"paper", {3, 1},
                                                 {3, 1},  {3, 1},
                                                 {3, 1},  format::SplitRule::median,
                                                 false,   format::TetraBounding::caps};

/// What finds overlaps and collisions soonest. Two trees of large cells win, since what
/// two cells that meet list is held against each other by blocks of 64 triangles, and many
/// small cells bring the same blocks again; the hashed octree wants small ones, since it
/// finds them for single triangles. Microseconds, median of 60 poses of armadillo and
/// bunny, overlapping triangles, then collisions; the hierarchy of boxes takes 48 and 4:
///
///                    octree    adaptive   tetra-tree   hashed
///     level 2      234, 43     234, 36     319, 74
///     level 3      185, 30     376, 51     374, 74    269, 66
///     level 4      195, 20    1502, 182    575, 96
///     level 8, 64                                     113, 21
///
/// All without boxes around what cells hold. With them the tetra-tree takes 3 to 4 times the
/// hierarchy's time for collisions and 2 to 5 times for overlaps at level 3; at level 4 a
/// sixth less and half as much more.
/// Of the eight times larger dragon each wants a level more. To ask what is inside, a deeper
/// tetra-tree is better: its costs are the triangles of one cone.
inline constexpr StructurePreset kTunedPreset = {"tuned", {5, 8},
                                                 {6, 32}, {4, 16},
                                                 {3, 64}, format::SplitRule::surface_area,
                                                 true,    format::TetraBounding::boxes};

inline constexpr std::array<StructurePreset, 2> kStructurePresets = {kPaperPreset, kTunedPreset};

}  // namespace cdprep::build
