// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/build_bvh.h"

namespace cdprep::build {

/// Fills the levels of bvh.nodes above the lowest, from that one.
void make_nodes(Bvh& bvh, ParallelFor parallel_for);

/// Marks boxes from `first` on as not used.
void set_unused_boxes(format::BvhNode& node, std::size_t first);

}  // namespace cdprep::build
