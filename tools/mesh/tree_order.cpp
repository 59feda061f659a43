// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tree_order.h"

#include <limits>

namespace cdprep::mesh {

TreeOrdered in_tree_order(const Mesh& mesh, std::span<const std::uint32_t> order) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    TreeOrdered ordered;
    ordered.new_vertex.assign(mesh.positions.size(), kNone);
    Mesh& result = ordered.mesh;
    result.single_precision = mesh.single_precision;
    result.positions.reserve(mesh.positions.size());
    result.source_vertex.reserve(mesh.positions.size());
    result.triangles.reserve(order.size());
    for (const std::uint32_t source : order) {
        Triangle triangle = mesh.triangles[source];
        for (std::uint32_t& vertex : triangle.vertex) {
            std::uint32_t& renamed = ordered.new_vertex[vertex];
            if (renamed == kNone) {
                renamed = static_cast<std::uint32_t>(result.positions.size());
                result.positions.push_back(mesh.positions[vertex]);
                result.source_vertex.push_back(mesh.source_vertex[vertex]);
            }
            vertex = renamed;
        }
        result.triangles.push_back(triangle);
    }
    return ordered;
}

}  // namespace cdprep::mesh
