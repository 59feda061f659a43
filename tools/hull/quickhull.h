// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep::convex {

using format::Double3;

/// A triangle of a closed surface.
struct HullFace {
    std::array<std::uint32_t, 3> corner;  ///< counter-clockwise from outside
    std::array<std::uint32_t, 3> across;  ///< face beyond the edge from corner i to the next
};

/// Returns the convex hull of points of which `first` are four that do not lie in one plane.
///
/// Exact: no point is in front of any face, and no face is degenerate. A face's neighbours
/// may be coplanar with it, and its corners inside coplanar faces or on straight edges.
/// Barber, Dobkin and Huhdanpaa's algorithm with exact signs: what lies in a face's plane is
/// not in front of it, and none of their repairs is needed. Expected O(n log n).
[[nodiscard]] std::vector<HullFace> quickhull(std::span<const Double3> points,
                                              const std::array<std::uint32_t, 4>& first);

}  // namespace cdprep::convex
