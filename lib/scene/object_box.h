// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/object_box.h"

namespace cdprep {

// root_box(), world_box() and may_meet() in the default floating-point environment, for a caller
// that has set it and has checked the reach. Without a BVH, a model has an absent box.

[[nodiscard]] RootBox placed_box(const Model& model, const Pose& world_from_model,
                                 double reach) noexcept;
[[nodiscard]] WorldBox box_around(const RootBox& root, const Double3& origin) noexcept;
/// Returns a box around the way between two placed boxes of one model. Its middle moves along a
/// straight line, and the model turns about it.
[[nodiscard]] RootBox swept_box(const RootBox& start, const RootBox& end) noexcept;
/// Returns the middle of a model's box, in its own coordinates.
[[nodiscard]] Double3 middle_of(const Model& model) noexcept;
[[nodiscard]] bool boxes_may_meet(const RootBox& a, const RootBox& b) noexcept;

}  // namespace cdprep
