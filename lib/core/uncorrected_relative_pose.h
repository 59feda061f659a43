// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/pose.h"

namespace cdprep {

/// As relative_pose(), without the correction of the rotation: Ra^T Rb, as rounding leaves it. The
/// slacks of boxes hold for this product, which stands for the two poses together.
[[nodiscard]] Pose uncorrected_relative_pose(const Pose& world_from_a,
                                             const Pose& world_from_b) noexcept;

}  // namespace cdprep
