// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/octree.h"

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
    std::vector<format::CellBox> boxes;        ///< around what the nodes hold
};

struct OctreeOptions {
    ParallelFor parallel_for = serial_for;
    std::uint32_t level = 3;      ///< no cell is deeper; 0 to format::kOctreeBits
    std::uint32_t threshold = 1;  ///< a cell with fewer triangles is not divided; 1 at least
    bool hashed = true;           ///< whether to make what finds cells by their keys
    /// The model's frame, where boxes are to be made: in it they are stored.
    std::optional<Frame> boxes_in{};
};

/// References that an octree may have beside kMostReferencesPerTriangle for each triangle.
inline constexpr std::uint64_t kMostFreeReferences = std::uint64_t{1} << 22;
inline constexpr std::uint64_t kMostReferencesPerTriangle = 64;

/// Bytes that building takes for each vertex, reference and node of the result.
inline constexpr std::size_t kScratchPerVertex = 16;
inline constexpr std::size_t kScratchPerReference = 10;
inline constexpr std::size_t kScratchPerNode = 96;

/// Builds the octree over triangles of finite positions of at most
/// format::kMaxCoordinate; references are their numbers in `triangles` (a model's: tree
/// order). A triangle is listed in every leaf whose closed cell it touches, exactly;
/// degenerate ones as the segment or point they are. Deterministic: the same bytes for
/// any parallel_for and any processor.
///
/// A level whose division would give the tree more than kMostFreeReferences and
/// kMostReferencesPerTriangle for each triangle is not divided, nor is any below: level 21
/// around a triangle that fills the cube has 2^42 cells. O(levels * references). Memory beside
/// the result: at most the sum of the three constants below. Throws nothing but
/// std::bad_alloc. Coordinates that are NaN are refused long before, by whoever read them;
/// here they give no answer.
[[nodiscard]] Octree build_octree(std::span<const format::Double3> positions,
                                  std::span<const format::Triangle> triangles,
                                  const OctreeOptions& options = {});

}  // namespace cdprep::build
