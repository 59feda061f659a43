// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cdprep/format/hulls.h"
#include "decompose/enclose/approximate_pieces.h"
#include "hull/mesh_hulls.h"

namespace cdprep::convex {

/// Hulls as a file stores them.
struct HullSections {
    std::vector<format::Hull> hulls;
    std::vector<format::HullBlock> blocks;
    std::vector<std::uint32_t> vertices;
    std::vector<format::HullFacet> facets;
    std::vector<format::HullGroup> groups;
    std::vector<std::uint32_t> neighbours;
    std::vector<std::uint32_t> starts;

    /// Adds a hull behind the others, which have lesser scopes and numbers. `source_vertex`
    /// names the vertices that its numbers are of. Neighbours and starts are stored from
    /// kClimbFrom points on.
    void add(format::HullScope scope, std::uint32_t number, const MeshHull& hull,
             std::span<const std::uint32_t> source_vertex);
};

/// Components of a mesh with more of them have no hulls of their own in a file.
inline constexpr std::size_t kMostComponentHulls = 1 << 16;

/// The hulls of a mesh: of the whole, of its components where there are several, but no
/// more than kMostComponentHulls, and of its instances where there are several. They are
/// exact, or have at most `max_vertices` points unless that is 0; nothing when one would
/// leave the range of double. `instances` are runs of `mesh`'s triangles.
[[nodiscard]] std::optional<HullSections> make_hull_sections(
    const mesh::Mesh& mesh, std::span<const format::Instance> instances, std::uint32_t max_vertices,
    ParallelFor run);

/// Adds pieces as parts, behind all other hulls, with their errors as distances.
void add_parts(HullSections& sections, std::span<const ApproximatePiece> pieces);

}  // namespace cdprep::convex
