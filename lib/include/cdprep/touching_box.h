// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/model.h"
#include "cdprep/touching.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// A solid box along the axes of the world. Limits may be infinite; lower > upper on
/// any axis is no box and touches nothing, nor does one with a NaN. Equal limits make
/// it flat, a segment or a point.
struct Box {
    Double3 lower;  ///< model units
    Double3 upper;  ///< inclusive
};

/// Returns whether `box` has a point in common with a triangle of `model`; stops at the
/// first found.
///
/// Exact: comparisons of coordinates and signs of determinants decide. A triangle in the
/// plane of a face touches, and so does one that is degenerate or inside.
///
/// An oriented box is an axis-aligned one in a frame of its own: with box_from_model as
/// options.world_from_model the question is whether the vertices, moved into that frame
/// in double, touch it. From two world poses that is
/// relative_pose(world_from_box, world_from_model).
///
/// Needs Ask::touch, as do the questions below. Costs O(log n) for most hits and misses.
/// Never allocates.
[[nodiscard]] bool touches(const Model& model, const Box& box, Workspace& workspace,
                           const TouchOptions& options = {}) noexcept;

/// Finds every triangle of `model` that has a point in common with the box.
///
/// Returns how many there are and stores the smallest of their numbers in the imported
/// file, sorted, in `triangles`; an empty span counts. As exact as touches().
[[nodiscard]] std::size_t touching_triangles(const Model& model, const Box& box,
                                             Workspace& workspace,
                                             std::span<std::uint32_t> triangles,
                                             const TouchOptions& options = {}) noexcept;

/// Calls `visit` with every triangle that touching_triangles() finds, each once, as it
/// is found; the order means nothing. Returns false when `visit` ended the search.
bool visit_touching_triangles(const Model& model, const Box& box, Workspace& workspace,
                              TriangleVisitor visit, const TouchOptions& options = {}) noexcept;

}  // namespace cdprep
