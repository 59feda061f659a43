// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>

#include "cells/octree_cells.h"
#include "kernels/curve.h"

namespace cdprep {

/// Returns the place of a finest cell along the Z-order curve: format::code_of() the key of level
/// kOctreeBits. The same on every machine; see kernels::Curve.
inline std::uint64_t octree_code(const CellPlace& cell) noexcept {
    assert(cell[0] < kOctreeSteps && cell[1] < kOctreeSteps && cell[2] < kOctreeSteps);
    return kernels::active_curve().code(cell[0], cell[1], cell[2]);
}

/// Returns the first finest cell of the cell with this key.
inline CellPlace octree_place(std::uint64_t key) noexcept {
    CellPlace place;
    kernels::active_curve().cell(code_of(key), place.data());
    return place;
}

}  // namespace cdprep
