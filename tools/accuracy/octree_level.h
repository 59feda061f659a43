// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cdprep/cells/build_octree.h"
#include "cdprep/pose.h"

namespace cdprep::study {

/// An octree whose leaf cells stand for the surface that they hold: a coarse model, coarser
/// with fewer levels. Its cells are closed and hold every triangle exactly.
struct CellModel {
    build::Octree octree;

    [[nodiscard]] std::uint64_t bytes() const noexcept {
        return octree.nodes.size() * sizeof(format::OctreeNode) + sizeof(format::OctreeGrid);
    }
    /// Edge of a leaf cell, model units: no point of one is farther from the surface than its
    /// diagonal.
    [[nodiscard]] double edge() const noexcept;
};

/// Whether any leaf cell of A may meet one of B when B is moved. False only where none does
/// for certain. `pending` is scratch; `visited`, or null, counts pairs of cells looked at.
[[nodiscard]] bool cells_may_meet(const CellModel& a, const CellModel& b, const Pose& a_from_b,
                                  std::vector<std::uint64_t>& pending,
                                  std::uint64_t* visited = nullptr);

}  // namespace cdprep::study
