// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// How a polygon came apart.
enum class PolygonCut : std::uint8_t {
    convex,  ///< a fan around corner 0
    ears,    ///< ears clipped one by one: the triangles cover the polygon once
    forced,  ///< no triangulation was found for a part, which is cut into a fan
};

/// Appends the outline.size() - 2 triangles of a polygon to `triangles`, as
/// numbers of its corners, wound like the polygon.
///
/// The polygon is looked at along the axis in which its area appears greatest,
/// where all decisions are exact. Concave outlines come out right, also with
/// straight corners, repeated positions, holes joined by a bridge and parts that
/// touch. A strictly convex outline is a fan around corner 0. Outlines that
/// cross themselves or have no area give `forced`, in a way that depends on the
/// corners alone. Fewer than three corners give nothing.
///
/// Coordinates must be finite and at most format::kMaxCoordinate. Linear for
/// convex outlines, quadratic to cubic otherwise; past a fixed number of steps
/// (about a second) the rest is `forced`.
PolygonCut triangulate_polygon(std::span<const Double3> outline,
                               std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace cdprep::mesh
