// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/build_bvh.h"

namespace cdprep::build {

/// Fills bvh.oriented_nodes from bvh.leaves, bvh.nodes and bvh.frame.
void make_oriented(Bvh& bvh, ParallelFor parallel_for);

}  // namespace cdprep::build
