// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/model.h"
#include "cdprep/shape_distance.h"
#include "cdprep/touching.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// All points at most `radius` from a segment: a solid cylinder with round ends.
struct Capsule {
    Double3 from;   ///< an end of the segment, model units, finite
    Double3 to;     ///< the other; may equal `from`, which makes it a sphere
    double radius;  ///< model units; negative or NaN touches nothing, 0 is the segment
};

/// Returns whether `capsule` has a point in common with a triangle of `model`; stops at
/// the first found.
///
/// Exact, tangent capsules included: distances are compared in integers where double
/// cannot tell. A capsule of radius 0 asks exactly about a segment, both ends included.
///
/// Needs Ask::touch, as do the questions below. Costs O(log n) for most hits and misses.
/// Never allocates.
[[nodiscard]] bool touches(const Model& model, const Capsule& capsule, Workspace& workspace,
                           const TouchOptions& options = {}) noexcept;

/// Finds every triangle of `model` that has a point in common with the capsule.
///
/// Returns how many there are and stores the smallest of their numbers in the imported
/// file, sorted, in `triangles`; an empty span counts. As exact as touches().
[[nodiscard]] std::size_t touching_triangles(const Model& model, const Capsule& capsule,
                                             Workspace& workspace,
                                             std::span<std::uint32_t> triangles,
                                             const TouchOptions& options = {}) noexcept;

/// Calls `visit` with every triangle that touching_triangles() finds, each once, as it
/// is found; the order means nothing. Returns false when `visit` ended the search.
bool visit_touching_triangles(const Model& model, const Capsule& capsule, Workspace& workspace,
                              TriangleVisitor visit, const TouchOptions& options = {}) noexcept;

/// Returns how far `capsule` is from the surface of `model`: 0, exactly, when they
/// touch; else the distance of its segment less its radius. Nothing when that exceeds
/// `max_distance`, the radius is negative or NaN, or there are no triangles.
///
/// See ShapeDistance for what is measured. Needs and costs as touches(), and visits
/// every triangle in the worst case. Never allocates.
[[nodiscard]] std::optional<ShapeDistance> distance_to(
    const Model& model, const Capsule& capsule, Workspace& workspace,
    const ShapeDistanceOptions& options = {}) noexcept;

}  // namespace cdprep
