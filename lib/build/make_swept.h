// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/build_bvh.h"

namespace cdprep::build {

/// Fills bvh.swept_nodes and bvh.swept_kind from bvh.leaves, bvh.frame and
/// bvh.oriented_nodes, whose axes and centres it starts from, and whose place they take
/// unless `bounds` wants both. It is one of the swept ones.
void make_swept(Bvh& bvh, BvhBounds bounds, ParallelFor parallel_for);

}  // namespace cdprep::build
