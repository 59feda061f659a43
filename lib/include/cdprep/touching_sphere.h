// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/model.h"
#include "cdprep/touching.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// A solid ball.
struct Sphere {
    Double3 centre;  ///< model units, finite
    double radius;   ///< model units; negative or NaN touches nothing, 0 is a point
};

/// Returns whether `sphere` has a point in common with a triangle of `model`, that is,
/// whether the surface is at most its radius from its centre; stops at the first found.
///
/// Exact, tangent spheres included: distances are compared in integers where double
/// cannot tell. If the distance itself matters, closest_point() measures it.
///
/// Needs Ask::touch, as do the questions below. Costs O(log n) for most hits and misses.
/// Never allocates.
[[nodiscard]] bool touches(const Model& model, const Sphere& sphere, Workspace& workspace,
                           const TouchOptions& options = {}) noexcept;

/// Finds every triangle of `model` that has a point in common with the sphere.
///
/// Returns how many there are and stores the smallest of their numbers in the imported
/// file, sorted, in `triangles`; an empty span counts. As exact as touches().
[[nodiscard]] std::size_t touching_triangles(const Model& model, const Sphere& sphere,
                                             Workspace& workspace,
                                             std::span<std::uint32_t> triangles,
                                             const TouchOptions& options = {}) noexcept;

/// Calls `visit` with every triangle that touching_triangles() finds, each once, as it
/// is found; the order means nothing. Returns false when `visit` ended the search.
bool visit_touching_triangles(const Model& model, const Sphere& sphere, Workspace& workspace,
                              TriangleVisitor visit, const TouchOptions& options = {}) noexcept;

}  // namespace cdprep
