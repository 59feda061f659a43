// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "cdprep/build_bvh.h"

namespace cdprep::build {

/// Fills bvh.leaves and bvh.exact_leaves from bvh.order and bvh.frame.
void make_leaves(Bvh& bvh, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, const ParallelFor& parallel_for);

}  // namespace cdprep::build
