// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep::mesh {

/// Returns the distance between two points in double, as welding computes it.
[[nodiscard]] double distance_between(const format::Double3& a, const format::Double3& b);

/// Returns for each point the lowest point of its group. Points at most `distance` apart are in
/// one group, and chains join. `distance` must be above 0, and coordinates finite. O(n) for
/// points that are about that far apart.
[[nodiscard]] std::vector<std::uint32_t> close_groups(const std::vector<format::Double3>& points,
                                                      double distance);

}  // namespace cdprep::mesh
