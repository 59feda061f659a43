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
    /// The steps ended first. The rest is a fan that may lie anywhere: do not use it.
    unfinished,
};

/// The default limit on the steps of one polygon. They take some seconds. Combs, rings and
/// snowflakes of a million corners need 50 to 130 million, corridors of half a million 120.
inline constexpr std::uint64_t kMaxPolygonSteps = 200'000'000;

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
/// outlines. Others take about n log n, if the boxes of their parts seldom overlap. Otherwise they
/// take up to cubic time: a star of 50,000 long thin points takes quadratic time, 140 million
/// steps. After about `max_steps` steps the polygon is `unfinished`.
PolygonCut triangulate_polygon(std::span<const Double3> outline,
                               std::vector<std::array<std::uint32_t, 3>>& triangles,
                               std::uint64_t max_steps = kMaxPolygonSteps);

}  // namespace cdprep::mesh
