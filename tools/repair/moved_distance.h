// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "repair/repair.h"

namespace cdprep::mesh {

struct MovedDistances {
    MovedDistance input_to_output;
    MovedDistance output_to_input;
};

/// Returns bounds on the distance that a repair moved the surface: the one-sided Hausdorff
/// distances in both directions. The upper bounds are proved.
///
/// Triangles with the corners of their source have distance 0. The distance of a fragment is
/// bounded by that of its corners from the source. If all fragments are present, the same bounds
/// the source. A dropped triangle that is still present as another triangle, side or corner has
/// the bound of that one.
///
/// All other distances are measured at corners, and inside triangles by splitting them. Splitting
/// ends when the bound is within 1e-4 of itself or 1e-9 of the model. It also ends after 200,000
/// new fragments in one direction, counted as four for each split. Source triangles without a place
/// are left out: those with a corner that is not finite or out of range.
[[nodiscard]] MovedDistances find_moved_distances(const TriangleSoup& soup, const RepairMesh& mesh);

}  // namespace cdprep::mesh
