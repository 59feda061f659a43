// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh.h"
#include "mesh/stop.h"

namespace cdprep::mesh {

/// The most points of a part that are tested of each kind. Every test takes time for all
/// triangles of the other parts.
inline constexpr std::size_t kMostTestPoints = 256;

/// Returns the winding number of other parts at a point; nothing if it lies on their surface.
using NumberAt = std::function<std::optional<int>(const Double3&)>;

/// Returns the first number found at a point of the triangles `part`; nothing if there is none,
/// or if stopped. Tests corners, then middles of edges, then points within triangles. Skips
/// points that are no doubles, because rounded ones may lie beyond the surface.
[[nodiscard]] std::optional<int> find_number_at_part(std::span<const Double3> positions,
                                                     std::span<const Triangle> triangles,
                                                     std::span<const std::uint32_t> part,
                                                     const NumberAt& number_at,
                                                     const StopCheck& stop);

}  // namespace cdprep::mesh
