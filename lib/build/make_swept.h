// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/build_bvh.h"

namespace cdprep::build {

/// Fills bvh.swept_nodes and bvh.swept_kind from bvh.leaves, bvh.frame and
/// bvh.oriented_nodes, whose axes and centres it starts from.
void make_swept(Bvh& bvh, format::SweptKind kind, const ParallelFor& parallel_for);

}  // namespace cdprep::build
