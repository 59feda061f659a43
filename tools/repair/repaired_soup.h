// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.h"
#include "repair/repair_step.h"

namespace cdprep::mesh {

/// A repaired mesh in the form of an import.
struct RepairedSoup {
    TriangleSoup soup;
    std::vector<std::uint32_t> triangle_from;  ///< the source of each triangle, or kNone: made
    std::vector<std::uint32_t> vertex_from;    ///< likewise for each vertex
};

/// Orders the triangles by their sources, with fragments of one source together. Those without a
/// source come last. Nodes, groups, materials and faces follow from the sources. Triangles
/// without a source form an instance and runs of their own, named "repair".
[[nodiscard]] RepairedSoup as_soup(const TriangleSoup& source, RepairMesh repaired);

}  // namespace cdprep::mesh
