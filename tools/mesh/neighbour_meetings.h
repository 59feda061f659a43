// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/self_intersections.h"
#include "mesh/vertex_stars.h"

namespace cdprep::mesh {

/// Finds the pairs of triangles with common vertices that meet elsewhere too, in no order.
/// Those of the stars have area.
[[nodiscard]] std::vector<TriangleMeeting> find_neighbour_meetings(const Mesh& mesh,
                                                                   const VertexStars& stars,
                                                                   ParallelFor parallel_for);

}  // namespace cdprep::mesh
