// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "repair/repair.h"

namespace cdprep::mesh {

struct MovedDistances {
    MovedDistance input_to_output;
    MovedDistance output_to_input;
};

/// How far a repair moved the surface: the one-sided Hausdorff distances both ways.
///
/// Triangles with the corners of their source are 0 away; pieces are bounded by the distance
/// of their corners to their source, and where all are there, the source by that. What was
/// left out but is there as another triangle, a side or a corner, is where that is. The rest
/// is measured: corners against the other surface, and their inside by cutting them until the bound
/// is within 1e-4 of itself, or 1e-9 of the model. The upper bounds are proved. Source triangles
/// with a corner that is not finite or out of range have no place and are left out.
[[nodiscard]] MovedDistances find_moved_distances(const TriangleSoup& soup, const RepairMesh& mesh);

}  // namespace cdprep::mesh
