// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.h"
#include "repair/repair_step.h"

namespace cdprep::mesh {

/// A repaired mesh as if it had been imported so.
struct RepairedSoup {
    TriangleSoup soup;
    std::vector<std::uint32_t> triangle_from;  ///< of each triangle its source, or kNone: made
    std::vector<std::uint32_t> vertex_from;    ///< likewise of each vertex
};

/// Puts the triangles in the order of their sources, pieces of one together, and those
/// without a source last. Nodes, groups, materials and faces follow from the sources;
/// triangles without one make an instance and runs of their own, named "repair".
[[nodiscard]] RepairedSoup as_soup(const TriangleSoup& source, RepairMesh repaired);

}  // namespace cdprep::mesh
