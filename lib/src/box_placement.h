// SPDX-License-Identifier: MIT
#pragma once

#include <array>

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

    /// The same map in double: pair = rotation * (scale_b * frame_b) + shift.
    std::array<double, 9> rotation;
    std::array<double, 3> shift;
    double scale_a;
    double scale_b;
    int exponent;  ///< of two: a pair unit is 2^-exponent model units
    /// How far vertices of the two models may be off, relative to each other,
    /// before any rounding to float. Pair units.
    double double_slack;
};

/// How far vertices of the two models may be off, relative to each other, model units.
[[nodiscard]] double double_slack(const Model& a, const Model& b,
                                  const Placement& placement) noexcept;

[[nodiscard]] PlacedBoxes place_boxes(const Model& a, const Model& b,
                                      const Placement& placement) noexcept;

}  // namespace cdprep
