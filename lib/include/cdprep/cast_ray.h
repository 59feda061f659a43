// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "cdprep/model.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// A half-line: origin + t * direction, t >= 0. Model coordinates: where the model
/// moves, turn the ray back into its frame.
struct Ray {
    Double3 origin;     ///< model units, finite
    Double3 direction;  ///< finite, not zero; any length
};

/// Where a ray meets a surface.
struct RayHit {
    double t;                ///< in lengths of the direction
    Double3 point;           ///< origin + t * direction, rounded
    std::uint32_t triangle;  ///< the imported file's number

    /// By t, then by triangle.
    friend bool operator<(const RayHit& a, const RayHit& b) noexcept;
};

struct RayOptions {
    /// Inclusive. Compared with the rounded t; for a segment whose ends decide exactly,
    /// ask touches() with a Capsule of radius 0.
    double max_t = std::numeric_limits<double>::infinity();
};

/// Returns the first point where `ray` meets the surface, or nothing.
///
/// Whether it hits a triangle is exact: the signs of the volumes that origin and
/// direction, as given, span with the edges. Closed: a ray along an edge or through a
/// vertex hits, so none slips between neighbours. Both sides count. A ray in a
/// triangle's plane hits where it enters. `t` and `point` are rounded, and so is what
/// they decide: which hit is first where two are as good as equal, and what max_t
/// leaves. Among hits whose t are equal the lowest source triangle answers. A model
/// without triangles is never hit, nor does a direction of zero hit anything.
///
/// Needs Ask::ray, as do the questions below. Costs O(log n) for compact surfaces. Never
/// allocates.
[[nodiscard]] std::optional<RayHit> cast_ray(const Model& model, const Ray& ray,
                                             Workspace& workspace,
                                             const RayOptions& options = {}) noexcept;

/// Returns whether `ray` hits any triangle: cast_ray() would answer. Exact while max_t
/// is infinite. Stops at the first found: less than cast_ray(), and enough for shadows
/// and lines of sight.
[[nodiscard]] bool ray_hits(const Model& model, const Ray& ray, Workspace& workspace,
                            const RayOptions& options = {}) noexcept;

/// Finds every triangle that `ray` hits, each once, where it hits it first.
///
/// Returns how many there are and stores the first of them, in the order of t and then
/// of triangles, in `hits`; an empty span counts. Which triangles are hit is as exact
/// as cast_ray(). A ray through an edge or vertex hits all triangles there.
[[nodiscard]] std::size_t all_ray_hits(const Model& model, const Ray& ray, Workspace& workspace,
                                       std::span<RayHit> hits,
                                       const RayOptions& options = {}) noexcept;

using RayVisitor = Visitor<RayHit>;

/// Calls `visit` with every hit that all_ray_hits() finds, as it is found; the order
/// means nothing. Returns false when `visit` ended the search.
bool visit_ray_hits(const Model& model, const Ray& ray, Workspace& workspace, RayVisitor visit,
                    const RayOptions& options = {}) noexcept;

}  // namespace cdprep
