// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/geometry.h"

namespace cdprep::convex {

using format::Double3;

/// Returns the numbers, ascending, of points among which all extreme points are: most of
/// those strictly inside the hull are left out, but none on its boundary. Those returned
/// have the same hull as all; they may be all. Coordinates must be finite. O(n) a pass,
/// of which there are at most eight.
[[nodiscard]] std::vector<std::uint32_t> cull_inside(std::span<const Double3> points,
                                                     ParallelFor run);

}  // namespace cdprep::convex
