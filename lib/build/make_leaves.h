// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/build_bvh.h"

namespace cdprep::build {

/// Fills bvh.leaves and the boxes around them, those of level 0 of bvh.nodes, from
/// bvh.order, bvh.frame and bvh.exact_leaves.
void make_leaves(Bvh& bvh, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, ParallelFor parallel_for);

}  // namespace cdprep::build
