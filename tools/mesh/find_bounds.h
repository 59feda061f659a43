// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/mesh.h"

namespace cdprep::convex {

/// Returns the exact axis-aligned box of all vertices, and an oriented box that contains them
/// too.
///
/// The oriented box follows the axes of the area-weighted covariance of the triangles. It is
/// widened so that rounding loses no vertex. If it would not be smaller than the axis-aligned
/// box, it is that box. An empty mesh has zeros. O(n).
[[nodiscard]] format::Bounds find_bounds(const mesh::Mesh& mesh);

}  // namespace cdprep::convex
