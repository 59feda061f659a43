// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/points.h"
#include "core/moved_model.h"
#include "exact/box3.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Returns a box that holds the model as moved. The model must have triangles.
[[nodiscard]] Box3 box_around(const MovedModel& model) noexcept;

/// Answers points_inside() for the model as moved, through the BVH; also for unbalanced models.
[[nodiscard]] Inclusion inclusion(const MovedModel& model, const Double3& q,
                                  Workspace::Storage& scratch) noexcept;

}  // namespace cdprep
