// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/api.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/octree.h"

namespace cdprep::build {

/// An octree of cells of equal shape (format/octree.h), and the tables that find a cell by its key.
/// These tables, in three forms, make the octree a hashed octree. Vectors that the options exclude
/// are empty. The last element of `top` is the number of leaves.
struct Octree {
    format::OctreeGrid grid{};
    std::vector<format::OctreeNode> nodes;
    std::vector<std::uint32_t> references;
    std::vector<std::uint64_t> leaf_codes;     ///< sorted form: Z-order codes of the leaves
    std::vector<std::uint32_t> leaf_nodes;     ///< the node of each of these leaves
    std::vector<std::uint32_t> top;            ///< leaves before each cell of grid.top_level
    std::vector<std::uint32_t> modulus_table;  ///< published form: chained, slot by last key bits
    std::vector<std::uint32_t> mixed_table;    ///< the same, slot by a mixed key
    std::vector<format::CellBox> boxes;        ///< one per node, around its contents
};

struct OctreeOptions {
    ParallelFor parallel_for = serial_for;
    std::uint32_t level = 3;      ///< no cell is deeper; 0 to format::kOctreeBits
    std::uint32_t threshold = 1;  ///< a cell with fewer triangles is not divided; at least 1
    bool hashed = true;           ///< also build the tables that find cells by their keys
    /// The model's frame, if boxes are to be built. They are stored in frame coordinates.
    std::optional<Frame> boxes_in{};
};

/// The number of references that an octree may have in addition to kMostReferencesPerTriangle for
/// each triangle.
inline constexpr std::uint64_t kMostFreeReferences = std::uint64_t{1} << 22;
inline constexpr std::uint64_t kMostReferencesPerTriangle = 64;

/// The scratch memory of a build, in bytes. Vertices are those of the input, references and nodes
/// those of the result.
inline constexpr std::size_t kScratchPerVertex = 16;
inline constexpr std::size_t kScratchPerReference = 10;
inline constexpr std::size_t kScratchPerNode = 96;

/// Builds the octree over triangles. Coordinates must be finite and at most format::kMaxCoordinate
/// in magnitude. References are triangle numbers in `triangles` (in a model: tree order). A
/// triangle is listed in exactly those leaves whose closed cell it touches. A degenerate triangle
/// counts as the segment or point that it is. The result is the same, byte for byte, for any
/// parallel_for and processor.
///
/// The total number of references is at most kMostFreeReferences plus kMostReferencesPerTriangle
/// for each triangle, and at most 2^31. A level whose division would exceed this limit is not
/// divided, nor is any level below. For example, a triangle as large as the cube would touch about
/// 2^42 cells of level 21. If coordinates are NaN, the result is meaningless; mesh readers reject
/// such coordinates.
///
/// Takes O(levels * references) time. Scratch memory is at most kScratchPerVertex * vertices +
/// kScratchPerReference * references + kScratchPerNode * nodes bytes, plus a few KiB. Throws only
/// std::bad_alloc.
[[nodiscard]] CDPREP_API Octree build_octree(std::span<const format::Double3> positions,
                                             std::span<const format::Triangle> triangles,
                                             const OctreeOptions& options = {});

}  // namespace cdprep::build
