// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"

namespace cdprep::build {

/// Fills octree.boxes from its nodes and references. All boxes are in `frame`, which contains the
/// positions. O(references), and 48 bytes of scratch for each node.
void bound_cells(Octree& octree, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, const Frame& frame,
                 ParallelFor parallel_for);

/// The same for an octree whose nodes chose their split points.
void bound_cells(AdaptiveOctree& octree, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, const Frame& frame,
                 ParallelFor parallel_for);

}  // namespace cdprep::build
