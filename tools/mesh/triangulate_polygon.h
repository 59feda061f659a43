// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// The result of splitting a polygon.
enum class PolygonCut : std::uint8_t {
    convex,  ///< a fan around corner 0
    ears,    ///< ears clipped one by one: the triangles cover the polygon once
    forced,  ///< no triangulation was found for a part; it is a fan
};

/// Appends the outline.size() - 2 triangles of a polygon to `triangles`, as numbers of its
/// corners, with the winding of the polygon.
///
/// The polygon is projected along the axis in which its area appears greatest. All decisions
/// there are exact. Concave outlines are correct, also with straight corners, repeated
/// positions, holes joined by a bridge and parts that touch. A strictly convex outline becomes a
/// fan around corner 0. Outlines that cross themselves or have no area give `forced`; the result
/// depends only on the corners. Fewer than three corners give nothing.
///
/// Coordinates must be finite and at most format::kMaxCoordinate. Takes linear time for convex
/// outlines, quadratic to cubic time otherwise. After a fixed number of steps (about a second)
/// the rest is `forced`.
PolygonCut triangulate_polygon(std::span<const Double3> outline,
                               std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace cdprep::mesh
