// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/source_places.h"
#include "mesh/vectors.h"

#include <algorithm>
#include <tuple>

namespace cdprep::mesh {

std::uint32_t source_corner(const TriangleSoup& soup, const SoundMesh& sound,
                            std::uint32_t triangle, std::uint32_t vertex) {
    const auto& corners = sound.mesh.triangles[triangle].vertex;
    const auto corner = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), vertex) -
                                                 corners.begin());
    return soup.triangles[sound.source_triangle[triangle]].vertex[corner];
}

Place place_of_edge(const TriangleSoup& soup, const SoundMesh& sound, const FlawedEdge& edge,
                    double measure) {
    return {{sound.source_triangle[edge.triangle]},
            {source_corner(soup, sound, edge.triangle, edge.from),
             source_corner(soup, sound, edge.triangle, edge.to)},
            middle_of(sound.mesh.positions[edge.from], sound.mesh.positions[edge.to]),
            measure};
}

bool comes_before(const FlawedEdge& a, const FlawedEdge& b) {
    return std::tie(a.triangle, a.from) < std::tie(b.triangle, b.from);
}

}  // namespace cdprep::mesh
