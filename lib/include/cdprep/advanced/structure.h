// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/ask.h"

namespace cdprep {

/// A structure of a file that finds answers. The answer is the same through each, but
/// distance() through pieces may name other triangles that touch.
enum class Structure : std::uint8_t {
    bvh,              ///< the hierarchy of boxes: the fastest for two models
    octree,           ///< both models' octrees, side by side
    adaptive_octree,  ///< both models' octrees with split points of their own
    /// Looks up cells of one model's octree by their keys, for each triangle of the other that
    /// may collide: cells that the triangle's box overlaps.
    hashed_octree,
    tetra_tree,  ///< both models' tetra-trees, side by side; the fastest for points
    pieces,      ///< both models' hierarchies over convex pieces of their surfaces
};

/// Returns the bit of Ask that a question through a structure needs besides its own; nothing for
/// Structure::bvh.
[[nodiscard]] Ask ask_of(Structure structure) noexcept;

}  // namespace cdprep
