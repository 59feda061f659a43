// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/points.h"

namespace cdprep {

/// Answers points_inside() through the BVH; also for open models.
[[nodiscard]] Inclusion inclusion_by_bvh(const Model& model, const Double3& p,
                                         Workspace& workspace) noexcept;

}  // namespace cdprep
