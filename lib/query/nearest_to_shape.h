// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/points.h"
#include "cdprep/workspace.h"
#include "core/moved_model.h"

namespace cdprep {

/// Returns how far the model's surface is from a triangle, segment or point, which it
/// does not touch, or nothing when that is more than `limit`.
[[nodiscard]] std::optional<ShapeDistance> nearest_to_shape(const MovedModel& model,
                                                            const Corners& shape, double limit,
                                                            Workspace::Storage& scratch) noexcept;

/// The answer for a triangle of the model, tree order, that a shape around these corners
/// touches: a common point of the two, or their nearest points.
[[nodiscard]] ShapeDistance touching_at(const MovedModel& model, const Corners& shape,
                                        std::uint32_t triangle) noexcept;

}  // namespace cdprep
