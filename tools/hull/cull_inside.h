// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/geometry.h"

namespace cdprep::convex {

using format::Double3;

/// Returns the numbers, ascending, of points that include all extreme points. Most points
/// strictly inside the hull are left out, but none on its boundary. The result has the same hull
/// as all points, and may contain all of them. Coordinates must be finite. Takes O(n) time: a pass
/// over the rest follows only if the last one dropped a tenth of it.
[[nodiscard]] std::vector<std::uint32_t> cull_inside(std::span<const Double3> points,
                                                     ParallelFor run);

}  // namespace cdprep::convex
