// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "cdprep/model.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// A half-line: origin + t * direction, t >= 0.
struct Ray {
    Double3 origin;     ///< model units, finite
    Double3 direction;  ///< finite, not zero; any length
};

/// Where a ray meets a surface.
struct RayHit {
    double t;                ///< in lengths of the direction
    std::uint32_t triangle;  ///< the imported file's number
    Double3 point;           ///< origin + t * direction, rounded
};

struct RayOptions {
    double max_t = std::numeric_limits<double>::infinity();  ///< inclusive
};

/// Returns the first point where `ray` meets the surface, or nothing.
///
/// Whether it hits a triangle is exact: the signs of the volumes that the line
/// through the origin and a second point, origin + 2^k direction rounded once (k
/// makes the step as large as the coordinates), spans with the edges. Closed: a
/// ray along an edge or through a vertex hits, so none slips between neighbours.
/// Both sides count. A ray in a triangle's plane hits where it enters. `t` and
/// `point` are rounded; among hits whose t are equal the lowest source triangle
/// answers. A model without triangles is never hit, nor does a direction of zero
/// hit anything.
///
/// Needs triangles, positions and bvh_nodes. Costs O(log n) for compact
/// surfaces. Never allocates.
[[nodiscard]] std::optional<RayHit> cast_ray(const Model& model, const Ray& ray,
                                             Workspace& workspace,
                                             const RayOptions& options = {}) noexcept;

}  // namespace cdprep
