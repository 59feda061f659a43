// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "cdprep/cells/build_octree.h"

namespace cdprep::build {

/// Fills octree.nodes and octree.references; octree.grid is set, but for the tables. There is
/// at least one triangle.
void divide_octree(Octree& octree, std::span<const format::Double3> positions,
                   std::span<const format::Triangle> triangles, ParallelFor parallel_for);

}  // namespace cdprep::build
