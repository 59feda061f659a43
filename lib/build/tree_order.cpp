// SPDX-License-Identifier: MIT
#include "cdprep/advanced/mesh_arrays.h"

namespace cdprep::build {

TreeOrder in_tree_order(std::size_t vertex_count, std::span<const format::Triangle> triangles,
                        std::span<const std::uint32_t> order) {
    TreeOrder made;
    made.new_vertex.assign(vertex_count, TreeOrder::kUnused);
    made.vertices.reserve(vertex_count);
    made.triangles.reserve(order.size());
    for (const std::uint32_t source : order) {
        format::Triangle triangle = triangles[source];
        for (std::uint32_t& vertex : triangle.vertex) {
            std::uint32_t& renamed = made.new_vertex[vertex];
            if (renamed == TreeOrder::kUnused) {
                renamed = static_cast<std::uint32_t>(made.vertices.size());
                made.vertices.push_back(vertex);
            }
            vertex = renamed;
        }
        made.triangles.push_back(triangle);
    }
    return made;
}

}  // namespace cdprep::build
