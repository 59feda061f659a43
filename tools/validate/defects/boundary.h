// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "validate/defects/edge_flaws.h"
#include "validate/defects/finding_list.h"
#include "mesh/point_tree.h"
#include "validate/defects/sound_mesh.h"
#include "mesh/stop.h"

namespace cdprep::mesh {

/// A connected set of boundary edges.
struct BoundaryLoop {
    std::uint32_t first_edge;  ///< the lowest of Boundary::edge
    std::uint32_t edges;
    Box box;
};

/// The edges that one triangle uses, and what they form.
struct Boundary {
    std::vector<FlawedEdge> edge;              ///< by ascending triangle
    std::vector<std::uint32_t> loop_of;        ///< of each edge
    std::vector<std::uint32_t> vertex;         ///< of the mesh, ascending: all ends
    std::vector<std::uint32_t> end_of_vertex;  ///< of the mesh: where it stands there, if it does
    std::vector<std::uint32_t> first_at;       ///< one more than those
    std::vector<std::uint32_t> edges_at;       ///< that end there, ascending: from first_at
    std::vector<BoundaryLoop> loop;            ///< by lowest edge

    /// Where a vertex of the boundary stands in `vertex`.
    [[nodiscard]] std::uint32_t end_at(std::uint32_t mesh_vertex) const {
        return end_of_vertex[mesh_vertex];
    }
    [[nodiscard]] std::span<const std::uint32_t> edges_of(std::uint32_t end) const {
        return std::span(edges_at).subspan(first_at[end], first_at[end + 1] - first_at[end]);
    }
};

[[nodiscard]] Boundary find_boundary(const Mesh& mesh, std::vector<FlawedEdge> edges);

/// CDP0301 and 0302.
void list_boundary(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                   FindingList& findings);

/// CDP0307: O(n log n) for edges that pass few vertices, and O(pairs) for those that do, up to
/// a number of vertices looked at that is linear in the boundary. Returns false when that or
/// `stop` ended the search: the count is then a lower bound.
bool find_t_junctions(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                      const StopCheck& stop, FindingList& findings, DefectCounts& counts);

/// CDP0308, for a width above 0. O(pairs within the width).
void find_near_seams(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                     double width, FindingList& findings, DefectCounts& counts);

}  // namespace cdprep::mesh
