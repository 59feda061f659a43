// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "core/moved_model.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// The triangle of a model nearest to a point.
struct NearestTriangle {
    std::uint32_t triangle;  ///< tree order; of equally near ones the lowest source number
    double lower;            ///< the distance of the surface is at least this
    double upper;            ///< and at most this
    Double3 point;           ///< on the triangle, up to rounding
};

/// Returns the triangle of a model, as moved, that is nearest to a point. Returns nothing if the
/// surface is farther than `max_distance`. Answers closest_point().
[[nodiscard]] std::optional<NearestTriangle> nearest_triangle(const MovedModel& model,
                                                              const Double3& query,
                                                              double max_distance,
                                                              Workspace::Storage& scratch) noexcept;

}  // namespace cdprep
