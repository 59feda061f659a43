// SPDX-License-Identifier: MIT
#pragma once

#include "repair/repair_step.h"
#include "support/meshes.h"

namespace cdprep::test {

/// The mesh as repair() first sees it.
inline mesh::RepairMesh repair_mesh_of(const TestMesh& mesh) {
    mesh::RepairMesh made;
    made.positions = mesh.positions;
    made.triangles = mesh.triangles;
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) made.vertex_origin.push_back({i, {}});
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        made.triangle_origin.push_back({i, {}});
    }
    return made;
}

}  // namespace cdprep::test
