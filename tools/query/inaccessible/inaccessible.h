// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// The triangles that are occluded along every ray towards the centre.
struct Inaccessible {
    std::vector<std::uint32_t> triangles;  ///< numbers in `triangles`, ascending
    /// The number of triangles that cover no direction: their plane contains the centre, or they
    /// are degenerate. The criterion does not apply to them, and `triangles` does not contain them.
    std::uint64_t edge_on = 0;
};

/// Finds the triangles that others occlude along every ray towards the centre of a tetra-tree. The
/// publications on tetra-trees use this criterion to select inaccessible parts. It is radial, not
/// true accessibility. A bent path may reach a triangle that no straight ray towards the centre
/// reaches. An undercut that is visible from the side counts as occluded.
///
/// The publications search for occluding triangles in the cones that contain a triangle. The cones
/// of a stored tree list too many triangles of a fine mesh, so this function uses only the centre.
/// Exact and deterministic. Takes O(n log n) time, plus, for each triangle, the number of triangles
/// that may occlude it.
[[nodiscard]] Inaccessible find_inaccessible(const Double3& centre,
                                             std::span<const Double3> positions,
                                             std::span<const Triangle> triangles,
                                             ParallelFor parallel_for = serial_for);

}  // namespace cdprep::mesh
