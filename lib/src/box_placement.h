// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/model.h"
#include "cdprep/placement.h"
#include "kernels.h"

namespace cdprep {

/// How the two hierarchies' boxes stand to each other, in float, with a slack
/// that makes every box test conservative for the vertices as the query moves
/// them: a pair that shares a point is never reported apart.
struct PlacedBoxes {
    kernels::BoxPlacement placement;
    bool apart;  ///< the root boxes are too far from each other to overlap
};

[[nodiscard]] PlacedBoxes place_boxes(const Model& a, const Model& b,
                                      const Placement& placement) noexcept;

}  // namespace cdprep
