// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/object_box.h"

namespace cdprep {

// root_box(), world_box() and may_meet() in the default floating-point environment, for a caller
// that has set it and has checked the reach. Without a BVH, a model has an absent box.

[[nodiscard]] RootBox placed_box(const Model& model, const Pose& world_from_model,
                                 double reach) noexcept;
[[nodiscard]] WorldBox box_around(const RootBox& root, const Double3& origin) noexcept;
[[nodiscard]] bool boxes_may_meet(const RootBox& a, const RootBox& b) noexcept;

}  // namespace cdprep
