// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cdprep/format/hulls.h"
#include "decompose/enclose/approximate_parts.h"
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

    /// Adds a hull after the others, which have smaller scopes and numbers. `source_vertex` maps
    /// the hull's numbers to vertices. Neighbours and starts are stored for hulls of kClimbFrom
    /// points or more.
    void add(format::HullScope scope, std::uint32_t number, const MeshHull& hull,
             std::span<const std::uint32_t> source_vertex);
};

/// The largest number of components for which a file stores component hulls: it limits the size of
/// the file.
inline constexpr std::size_t kMostComponentHulls = 1 << 16;

/// Returns the hulls of a mesh: of the whole, of its components and of its instances. Components
/// and instances get hulls only if there are several, components only up to kMostComponentHulls.
/// Hulls are exact, or have at most `max_vertices` points unless that is 0. Returns nothing if a
/// hull would exceed the range of double. `instances` are runs of `mesh`'s triangles.
[[nodiscard]] std::optional<HullSections> make_hull_sections(
    const mesh::Mesh& mesh, std::span<const format::Instance> instances, std::uint32_t max_vertices,
    ParallelFor run);

/// Adds the hulls of parts after all others, with the errors of the parts as distances.
void add_parts(HullSections& sections, std::span<const ApproximatePart> parts);

}  // namespace cdprep::convex
