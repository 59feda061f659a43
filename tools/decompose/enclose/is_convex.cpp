// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/is_convex.h"

#include <vector>

#include "cdprep/exact/predicates.h"
#include "mesh/exact_volume.h"
#include "mesh/half_edges.h"

namespace cdprep::convex {

bool is_convex(const mesh::Mesh& mesh, std::span<const std::uint32_t> triangles,
               const ConvexHull& hull) {
    if (hull.dimension != 3) return false;
    std::vector<mesh::Triangle> list;
    for (const std::uint32_t i : triangles) list.push_back(mesh.triangles[i]);
    const mesh::EdgeUses edges = mesh::find_edge_uses(list, mesh.positions.size());
    int turn = 0;  // 1: apexes are behind, -1: inside out
    const auto at = [&](std::uint32_t vertex) -> const Double3& { return mesh.positions[vertex]; };
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        if (uses.size() != 2) return false;
        if (mesh::start_of(list, uses[0]) == mesh::start_of(list, uses[1])) return false;
        const auto& v = list[uses[0] / 3].vertex;
        const int behind =
            exact::orient3d(at(v[0]), at(v[1]), at(v[2]), at(mesh::apex_of(list, uses[1])));
        if (behind * turn < 0) return false;
        if (behind != 0) turn = behind;
    }
    mesh::ExactVolume difference;
    for (const mesh::Triangle& t : list) {
        difference.add(at(t.vertex[0]), at(t.vertex[1]), at(t.vertex[2]));
    }
    // The facets of the hull are wound the other way, and so subtracted.
    const std::size_t second = turn < 0 ? 1 : 2;
    for (const auto& f : hull.facets) {
        difference.add(hull.points[f[0]], hull.points[f[second]], hull.points[f[3 - second]]);
    }
    return difference.sign() == 0;
}

}  // namespace cdprep::convex
