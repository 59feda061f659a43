// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/points.h"
#include "cdprep/workspace.h"
#include "core/moved_model.h"

namespace cdprep {

/// Returns the distance of the model's surface from a triangle, segment or point that it does not
/// touch. Returns nothing if the distance exceeds `limit`.
[[nodiscard]] std::optional<ShapeDistance> nearest_to_shape(const MovedModel& model,
                                                            const Corners& shape, double limit,
                                                            Workspace::Storage& scratch) noexcept;

/// Returns the answer for a triangle of the model, tree order, that a shape around these corners
/// touches. The witnesses are a common point of the two, or their nearest points.
[[nodiscard]] ShapeDistance touching_at(const MovedModel& model, const Corners& shape,
                                        std::uint32_t triangle) noexcept;

}  // namespace cdprep
