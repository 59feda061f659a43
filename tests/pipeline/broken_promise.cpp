// SPDX-License-Identifier: MIT
// The program with a fault: its octrees' cells never meet. They enclose the surface, so the
// study of accuracy promises that they miss nothing. The linker takes these functions, which are
// all of octree_level.cpp, and leaves the library's.
#include "accuracy/octree_level.h"

namespace cdprep::study {

double CellModel::edge() const noexcept {
    return octree.grid.step;
}

bool cells_may_meet(const CellModel& /*a*/, const CellModel& /*b*/, const Pose& /*a_from_b*/,
                    std::vector<std::uint64_t>& /*pending*/, std::uint64_t* /*visited*/) {
    return false;
}

}  // namespace cdprep::study
