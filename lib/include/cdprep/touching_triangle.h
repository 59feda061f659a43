// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/model.h"
#include "cdprep/shape_distance.h"
#include "cdprep/touching.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// One triangle by its corners; model units, finite. Collinear or equal corners make it
/// the segment or point that they span.
struct TriangleShape {
    std::array<Double3, 3> corner;
};

/// Returns whether `triangle` has a point in common with one of `model`; stops at the
/// first found. Exact, as overlapping_triangles() with Overlap::closed.
///
/// Needs Ask::touch, as do the questions below. Costs O(log n) for most hits and misses.
/// Never allocates.
[[nodiscard]] bool touches(const Model& model, const TriangleShape& triangle, Workspace& workspace,
                           const TouchOptions& options = {}) noexcept;

/// Finds every triangle of `model` that has a point in common with the triangle.
///
/// Returns how many there are and stores the smallest of their numbers in the imported
/// file, sorted, in `triangles`; an empty span counts. As exact as touches().
[[nodiscard]] std::size_t touching_triangles(const Model& model, const TriangleShape& triangle,
                                             Workspace& workspace,
                                             std::span<std::uint32_t> triangles,
                                             const TouchOptions& options = {}) noexcept;

/// Calls `visit` with every triangle that touching_triangles() finds, each once, as it
/// is found; the order means nothing. Returns false when `visit` ended the search.
bool visit_touching_triangles(const Model& model, const TriangleShape& triangle,
                              Workspace& workspace, TriangleVisitor visit,
                              const TouchOptions& options = {}) noexcept;

/// Returns how far `triangle` is from the surface of `model`: 0, exactly, when they
/// touch. Nothing when that exceeds `max_distance` or the model has no triangles.
///
/// See ShapeDistance for what is measured. Needs and costs as touches(), and visits
/// every triangle in the worst case. Never allocates.
[[nodiscard]] std::optional<ShapeDistance> distance_to(
    const Model& model, const TriangleShape& triangle, Workspace& workspace,
    const ShapeDistanceOptions& options = {}) noexcept;

}  // namespace cdprep
