// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/point_tree.h"
#include "mesh/stop.h"
#include "validate/defects/edge_flaws.h"
#include "validate/defects/finding_list.h"
#include "validate/defects/sound_mesh.h"

namespace cdprep::mesh {

/// A connected set of boundary edges.
struct BoundaryLoop {
    std::uint32_t first_edge;  ///< the lowest index into Boundary::edge
    std::uint32_t edges;
    Box box;
};

/// The edges that exactly one triangle uses, and the loops they form.
struct Boundary {
    std::vector<FlawedEdge> edge;              ///< by ascending triangle
    std::vector<std::uint32_t> loop_of;        ///< the loop of each edge
    std::vector<std::uint32_t> vertex;         ///< the mesh numbers of all end vertices, ascending
    std::vector<std::uint32_t> end_of_vertex;  ///< by mesh vertex: its index in `vertex`
    std::vector<std::uint32_t> first_at;       ///< by end: its first in edges_at; one more
    std::vector<std::uint32_t> edges_at;       ///< the edges at each end, ascending
    std::vector<BoundaryLoop> loop;            ///< in order of the lowest edge

    /// Returns the index in `vertex` of a boundary vertex.
    [[nodiscard]] std::uint32_t end_at(std::uint32_t mesh_vertex) const {
        return end_of_vertex[mesh_vertex];
    }
    [[nodiscard]] std::span<const std::uint32_t> edges_of(std::uint32_t end) const {
        return std::span(edges_at).subspan(first_at[end], first_at[end + 1] - first_at[end]);
    }
};

[[nodiscard]] Boundary find_boundary(const Mesh& mesh, std::vector<FlawedEdge> edges);

/// Lists boundary edges and loops (CDP0301, CDP0302).
void list_boundary(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                   FindingList& findings);

/// Finds T-junctions (CDP0307). Takes O(n log n) if edges pass few vertices, else O(pairs). The
/// number of vertices examined is limited, linearly in the size of the boundary. Returns false
/// if this limit or `stop` ended the search; the count is then a lower bound.
bool find_t_junctions(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                      const StopCheck& stop, FindingList& findings, DefectCounts& counts);

/// Finds seams with a gap (CDP0308), for a width above 0. Takes O(pairs within the width).
void find_near_seams(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                     double width, FindingList& findings, DefectCounts& counts);

}  // namespace cdprep::mesh
