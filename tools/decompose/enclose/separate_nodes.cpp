// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/separate_nodes.h"

#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace cdprep::convex {

mesh::Mesh separate_nodes(const mesh::Mesh& mesh, std::span<const std::uint32_t> node_of) {
    mesh::Mesh separated = mesh;
    if (node_of.empty()) return separated;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;
    std::vector<std::uint32_t> first(mesh.positions.size(),
                                     std::numeric_limits<std::uint32_t>::max());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::uint32_t& vertex : separated.triangles[i].vertex) {
            std::uint32_t& owner = first[vertex];
            if (owner == std::numeric_limits<std::uint32_t>::max()) owner = node_of[i];
            if (owner == node_of[i]) continue;
            const auto [at, is_new] = copies.try_emplace(
                {vertex, node_of[i]}, static_cast<std::uint32_t>(separated.positions.size()));
            if (is_new) separated.positions.push_back(mesh.positions[vertex]);
            vertex = at->second;
        }
    }
    return separated;
}

}  // namespace cdprep::convex
