// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "cdprep/model.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// Where the surface comes nearest to a point.
struct ClosestPoint {
    Double3 point;           ///< on the surface up to rounding, model units
    double lower;            ///< the distance is at least this, model units
    double upper;            ///< and at most this: [lower, upper] holds the exact one
    std::uint32_t triangle;  ///< the imported file's number
};

/// Returns the point of `model`'s surface nearest to `query`, or nothing when
/// no part of it is within `max_distance`.
///
/// Distance is to the surface, not to the solid: a point deep inside a closed
/// model is far away. When several triangles are equally near as far as double
/// can tell, the one with the smallest number answers.
///
/// `query` must be finite. `max_distance` may be infinite and is inclusive:
/// nothing that near is missed, and what is found has `lower` at most
/// `max_distance`. The interval always holds the truth (closest_point_laws_test);
/// it is a few ulp of the triangle's farthest corner wide, more for slivers.
/// Needs Ask::closest. Never allocates. Visits every node
/// in the worst case: a point at the centre of a sphere.
///
///     if (auto near = cdprep::closest_point(model, {0, 0, 2}, workspace)) {
///         std::cout << "triangle " << near->triangle << " at " << near->upper << '\n';
///     }
[[nodiscard]] std::optional<ClosestPoint> closest_point(
    const Model& model, const Double3& query, Workspace& workspace,
    double max_distance = std::numeric_limits<double>::infinity()) noexcept;

}  // namespace cdprep
