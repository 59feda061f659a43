// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "build/lanes.h"
#include "cdprep/advanced/parallel_for.h"
#include "cells/octree_cells.h"

namespace cdprep::build {

/// Returns the cube around all positions and its finest planes, as format::OctreeGrid defines them.
/// The middle of the positions' box is the cube's middle. The cube extends more than a step beyond
/// the box on every side, and planes rise strictly. Without positions, the cube is around the
/// origin. `level`, `threshold` and the fields for tables are 0.
[[nodiscard]] format::OctreeGrid octree_grid_around(std::span<const Double3> positions,
                                                    ParallelFor parallel_for);

/// The place of a vertex among the finest planes of each axis, doubled. It is 2 i on plane i and
/// 2 i + 1 strictly between planes i and i + 1. A point on a plane touches both sides. So this
/// value, unlike the number of a cell, determines exactly which closed cells hold a vertex. Floats
/// hold its 22 bits exactly. A fourth lane is always 0, so that one instruction compares all axes.
using Stand = Lanes<float, 4>;

[[nodiscard]] inline float octree_stand(double origin, double step, double x) noexcept {
    const std::uint32_t cell = octree_cell(origin, step, x);
    const bool between = x > octree_plane(origin, step, cell);
    return static_cast<float>(2 * cell + (between ? 1 : 0));
}

[[nodiscard]] inline Stand octree_stand(const format::OctreeGrid& grid, const Double3& p) noexcept {
    return {octree_stand(grid.origin.x, grid.step, p.x),
            octree_stand(grid.origin.y, grid.step, p.y),
            octree_stand(grid.origin.z, grid.step, p.z), 0};
}

}  // namespace cdprep::build
