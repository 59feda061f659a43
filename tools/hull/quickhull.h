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
    std::array<std::uint32_t, 3> across;  ///< the face across the edge from corner i to the next
};

/// Returns the convex hull of points; `first` are four of them that are not coplanar.
///
/// Exact: no point is in front of any face, and no face is degenerate. Neighbouring faces may be
/// coplanar. Corners may lie inside coplanar faces or on straight edges. The algorithm is that
/// of Barber, Dobkin and Huhdanpaa, with exact signs. A point in a face's plane is not in front
/// of it, and their repairs are unnecessary. Expected O(n log n).
[[nodiscard]] std::vector<HullFace> quickhull(std::span<const Double3> points,
                                              const std::array<std::uint32_t, 4>& first);

}  // namespace cdprep::convex
