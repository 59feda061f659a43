// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"
#include "cdprep/format/octree.h"
#include "cdprep/parallel_for.h"

namespace cdprep::build {

/// An octree of cells of equal shape, as format/octree.h has it; and what finds a cell
/// by its key. Vectors that were not asked for are empty.
struct Octree {
    format::OctreeGrid grid{};
    std::vector<format::OctreeNode> nodes;
    std::vector<std::uint32_t> references;
    std::vector<std::uint64_t> leaf_codes;     ///< the hashed octree's modern form:
    std::vector<std::uint32_t> leaf_nodes;     ///< leaves sorted along the z curve,
    std::vector<std::uint32_t> top;            ///< with a table of where to begin
    std::vector<std::uint32_t> modulus_table;  ///< its literal form
    std::vector<std::uint32_t> mixed_table;    ///< the same with mixed keys
};

struct OctreeOptions {
    ParallelFor parallel_for = serial_for;
    std::uint32_t level = 3;      ///< no cell is deeper; 0 to format::kOctreeBits
    std::uint32_t threshold = 1;  ///< a cell with fewer triangles is not divided; 1 at least
    bool hashed = true;           ///< whether to make what finds cells by their keys
};

/// Builds the octree over triangles of finite positions of at most
/// format::kMaxCoordinate; references are their numbers in `triangles` (a model's: tree
/// order). A triangle is listed in every leaf whose closed cell it touches, exactly;
/// degenerate ones as the segment or point they are. Deterministic: the same bytes for
/// any parallel_for and any processor. O(references); scratch is stated at the definition
/// and bounded by a multiple of the input and the result.
[[nodiscard]] Octree build_octree(std::span<const format::Double3> positions,
                                  std::span<const format::Triangle> triangles,
                                  const OctreeOptions& options = {});

}  // namespace cdprep::build
