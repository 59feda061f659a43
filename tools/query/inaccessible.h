// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Which triangles nothing reaches that comes straight towards the centre.
struct Inaccessible {
    std::vector<std::uint32_t> triangles;  ///< numbers in `triangles`, rising
    /// Triangles that cover no direction, since their plane holds the centre or they are
    /// degenerate: the criterion says nothing of them and they are not among `triangles`.
    std::uint64_t edge_on = 0;
};

/// Finds the triangles that others hide along every ray towards the centre, a tetra-tree's:
/// the selection of inaccessible parts of the tetra-tree papers. A radial criterion, not true
/// accessibility: what a straight approach to the centre cannot reach, a bent one may,
/// and an undercut that is seen from the side counts as hidden.
///
/// The papers look for what hides a triangle in the cones that hold it; what the cones of a
/// stored tree list is too much of a fine mesh, and this needs no more of it than the centre.
/// Exact; deterministic. O(n log n), and for each triangle those that may hide it.
[[nodiscard]] Inaccessible find_inaccessible(const Double3& centre,
                                             std::span<const Double3> positions,
                                             std::span<const Triangle> triangles,
                                             ParallelFor parallel_for = serial_for);

}  // namespace cdprep::mesh
