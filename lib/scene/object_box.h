// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/broad_phase.h"
#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

/// Returns a box that contains all points of a moved model, as transform_point() rounds them, and
/// reaches `reach` beyond them. The box of a model without triangles is absent.
[[nodiscard]] WorldBox object_box(const Model& model, const Pose& world_from_model,
                                  double reach) noexcept;

}  // namespace cdprep
