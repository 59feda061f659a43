// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/parallel_for.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// How two triangles of one mesh meet where they should not.
enum class Meeting : std::uint8_t {
    crossing,          ///< one runs through the other
    touching,          ///< without a common vertex, they touch
    coplanar_overlap,  ///< without a common vertex, in one plane, they share area
    fold,              ///< with a common vertex or edge, in one plane, they share area
    duplicate,         ///< the same three corners
};

struct TriangleMeeting {
    std::uint32_t a;  ///< triangle of the mesh; a < b
    std::uint32_t b;
    Meeting meeting;
};

/// Finds every pair of triangles of a mesh that have more in common than the vertices
/// and edges they share, each pair once, sorted by (a, b). Triangles of zero area answer
/// as CGAL's self_intersections leaves them: not at all.
///
/// Exact. The same for any parallel_for.
[[nodiscard]] std::vector<TriangleMeeting> find_self_intersections(
    const Mesh& mesh, ParallelFor parallel_for = serial_for);

}  // namespace cdprep::mesh
