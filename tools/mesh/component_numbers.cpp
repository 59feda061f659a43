// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/component_numbers.h"

#include <limits>

#include "mesh/disjoint_sets.h"

namespace cdprep::mesh {

ComponentNumbers number_components(const Mesh& mesh) {
    DisjointSets sets(mesh.positions.size());
    for (const Triangle& triangle : mesh.triangles) {
        sets.unite(triangle.vertex[0], triangle.vertex[1]);
        sets.unite(triangle.vertex[0], triangle.vertex[2]);
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    ComponentNumbers numbers;
    numbers.of_vertex.assign(mesh.positions.size(), kNone);
    for (const Triangle& triangle : mesh.triangles) {
        std::uint32_t& number = numbers.of_vertex[sets.root_of(triangle.vertex[0])];
        if (number == kNone) number = static_cast<std::uint32_t>(numbers.count++);
        for (const std::uint32_t vertex : triangle.vertex) numbers.of_vertex[vertex] = number;
    }
    return numbers;
}

}  // namespace cdprep::mesh
