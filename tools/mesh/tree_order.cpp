// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tree_order.h"

#include <utility>

#include "cdprep/advanced/mesh_arrays.h"

namespace cdprep::mesh {

TreeOrdered in_tree_order(const Mesh& mesh, std::span<const std::uint32_t> order) {
    build::TreeOrder made = build::in_tree_order(mesh.positions.size(), mesh.triangles, order);
    TreeOrdered ordered;
    ordered.new_vertex = std::move(made.new_vertex);
    Mesh& result = ordered.mesh;
    result.single_precision = mesh.single_precision;
    result.triangles = std::move(made.triangles);
    result.positions.reserve(made.vertices.size());
    result.source_vertex.reserve(made.vertices.size());
    for (const std::uint32_t vertex : made.vertices) {
        result.positions.push_back(mesh.positions[vertex]);
        result.source_vertex.push_back(mesh.source_vertex[vertex]);
    }
    return ordered;
}

}  // namespace cdprep::mesh
