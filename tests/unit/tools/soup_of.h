// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>

#include "mesh/mesh.h"
#include "mesh/weld.h"
#include "support/meshes.h"

namespace cdprep::test {

/// The soup that an import of `mesh` gives.
inline mesh::TriangleSoup soup_of(const TestMesh& mesh) {
    mesh::TriangleSoup soup;
    soup.positions = mesh.positions;
    soup.triangles = mesh.triangles;
    return soup;
}

inline mesh::Mesh welded(const TestMesh& mesh) {
    return mesh::weld(soup_of(mesh)).mesh;
}

/// Every triangle with vertices of its own.
inline TestMesh unshared(const TestMesh& mesh) {
    TestMesh apart;
    for (const Triangle& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(apart.positions.size());
        for (const std::uint32_t vertex : triangle.vertex) {
            apart.positions.push_back(mesh.positions[vertex]);
        }
        apart.triangles.push_back({{first, first + 1, first + 2}});
    }
    return apart;
}

/// A mesh whose vertices are taken as they are shared.
inline mesh::Mesh mesh_of(const TestMesh& test_mesh) {
    mesh::Mesh mesh;
    mesh.positions = test_mesh.positions;
    mesh.triangles = test_mesh.triangles;
    mesh.source_vertex.resize(mesh.positions.size());
    std::iota(mesh.source_vertex.begin(), mesh.source_vertex.end(), 0U);
    return mesh;
}

}  // namespace cdprep::test
