// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/build_bvh.h"

namespace cdprep::build {

/// Fills bvh.swept_nodes and bvh.swept_kind from bvh.leaves, bvh.frame and bvh.oriented_nodes.
/// Starts from the axes and centres of bvh.oriented_nodes, and clears these unless `bounds` selects
/// both. Requires that `bounds` selects swept spheres.
void make_swept(Bvh& bvh, BvhBounds bounds, ParallelFor parallel_for);

}  // namespace cdprep::build
