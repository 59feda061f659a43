// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/ask.h"
#include "cdprep/format/api.h"

namespace cdprep {

/// A structure of a file through which queries are computed. All structures give the same answer,
/// with two exceptions. distance() through pieces may name another pair of touching triangles. With
/// permitted errors, it may return another distance within these errors.
enum class Structure : std::uint8_t {
    bvh,              ///< the hierarchy of boxes; the fastest for two models
    octree,           ///< both models' octrees, side by side
    adaptive_octree,  ///< both models' octrees with chosen split points
    /// One model's octree. For each triangle of the other model that may collide, the cells under
    /// its box are looked up by key.
    hashed_octree,
    tetra_tree,  ///< both models' tetra-trees, side by side; the fastest for points
    pieces,      ///< both models' BVHs over convex pieces of their surfaces
};

/// Returns the bit of Ask that a query through a structure requires in addition to the query's own
/// bit. Returns Ask::nothing for Structure::bvh.
[[nodiscard]] CDPREP_API Ask ask_of(Structure structure) noexcept;

}  // namespace cdprep
