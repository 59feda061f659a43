// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "support/more_sections.h"
#include "support/open_tiny.h"

#include "cdprep/advanced/structure.h"
#include "cdprep/cells/overlap_through.h"

namespace cdprep::test {

inline constexpr std::array kStructures = {Structure::bvh, Structure::octree,
                                           Structure::adaptive_octree, Structure::hashed_octree,
                                           Structure::tetra_tree};

inline constexpr std::array kSearches = {CellSearch::sorted, CellSearch::modulus,
                                         CellSearch::mixed};

inline std::string name_of(Structure structure) {
    constexpr std::array<const char*, 5> kNames = {"bvh", "octree", "adaptive_octree",
                                                   "hashed_octree", "tetra_tree"};
    return kNames.at(static_cast<std::size_t>(structure));
}

/// The depth to which structures divide their triangles.
struct Division {
    std::uint32_t level = 3;
    std::uint32_t threshold = 1;
    bool boxes = false;  ///< boxes bound the triangles in each octree cell
};

/// Returns the baked file with every structure that a query can use.
[[nodiscard]] AlignedBytes with_every_structure(const AlignedBytes& file,
                                                const Division& division = {});

/// Bakes such a file in double precision and opens it.
[[nodiscard]] OpenModel open_with_every_structure(const TestMesh& mesh,
                                                  const Division& division = {});

/// Bakes a file with an octree and opens it.
inline OpenModel open_with_octree(const TestMesh& mesh, const build::OctreeOptions& octree,
                                  const TinyOptions& options = {}) {
    return open_tiny(with_octree(bake_tiny(mesh.positions, mesh.triangles, options), octree));
}

/// Returns the pairs of triangles that overlap, by a search through cells.
inline std::vector<TrianglePair> pairs_through(const StructureOptions& through, const Model& a,
                                               const Model& b, const Placement& placement,
                                               Workspace& workspace,
                                               const PairOptions& options = {}) {
    std::vector<TrianglePair> pairs(
        overlaps_through({a, b, placement, options}, through, workspace, {}));
    pairs.resize(overlaps_through({a, b, placement, options}, through, workspace, pairs));
    return pairs;
}

}  // namespace cdprep::test
