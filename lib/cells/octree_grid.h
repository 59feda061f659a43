// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "build/lanes.h"
#include "cdprep/advanced/parallel_for.h"
#include "cells/octree_cells.h"

namespace cdprep::build {

/// The cube around all positions and its finest planes, as format::OctreeGrid defines them:
/// the middle of their box in the middle, more than a step beyond on every side, planes that
/// rise strictly. Around the origin where there are none. `level`, `threshold` and what
/// concerns tables are left 0.
[[nodiscard]] format::OctreeGrid octree_grid_around(std::span<const Double3> positions,
                                                    ParallelFor parallel_for);

/// Where a vertex stands among the finest planes of each axis, doubled: 2 i on plane i,
/// 2 i + 1 strictly between planes i and i + 1. What lies on a plane touches both sides, so
/// this, unlike a number of a cell, tells exactly which closed cells a vertex is in. Floats,
/// which hold 22 bits exactly, and a fourth lane, always 0, so that one instruction compares
/// all axes.
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
