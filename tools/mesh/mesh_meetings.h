// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/repair_step.h"
#include "mesh/self_intersections.h"

namespace cdprep::mesh {

/// Pairs of triangles of the mesh that meet where they are no neighbours, by number.
/// Vertices with equal positions count as one: what was parted touches, and is no finding.
[[nodiscard]] std::vector<TriangleMeeting> find_meetings(const RepairMesh& mesh,
                                                         ParallelFor parallel_for);

/// "triangle 17", or that a step made it.
[[nodiscard]] std::string triangle_in_words(const RepairMesh& mesh, std::uint32_t triangle);

}  // namespace cdprep::mesh
