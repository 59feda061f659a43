// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cdprep/cells/build_octree.h"
#include "cdprep/pose.h"

namespace cdprep::study {

/// An octree whose leaf cells approximate the surface inside them: a coarse model, coarser with
/// fewer levels. Its cells are closed, and together they exactly contain every triangle.
struct CellModel {
    build::Octree octree;

    [[nodiscard]] std::uint64_t bytes() const noexcept {
        return octree.nodes.size() * sizeof(format::OctreeNode) + sizeof(format::OctreeGrid);
    }
    /// Returns the edge of a leaf cell in model units. No point of a leaf cell is farther from the
    /// surface than the cell's diagonal.
    [[nodiscard]] double edge() const noexcept;
};

/// Returns whether any leaf cell of A may meet a leaf cell of the moved B. False is certain.
/// `pending` is scratch memory. `visited`, if not null, counts the tested pairs of cells.
[[nodiscard]] bool cells_may_meet(const CellModel& a, const CellModel& b, const Pose& a_from_b,
                                  std::vector<std::uint64_t>& pending,
                                  std::uint64_t* visited = nullptr);

}  // namespace cdprep::study
