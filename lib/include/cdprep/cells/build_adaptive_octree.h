// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/octree.h"

namespace cdprep::build {

/// An octree whose nodes choose their split points, as format/octree.h has it.
struct AdaptiveOctree {
    format::AdaptiveOctree tree{};
    std::vector<format::AdaptiveOctreeNode> nodes;
    std::vector<std::uint32_t> references;
    std::vector<format::CellBox> boxes;  ///< around what the nodes hold
};

struct AdaptiveOctreeOptions {
    ParallelFor parallel_for = serial_for;
    std::uint32_t level = 3;      ///< no cell is deeper; 0 to format::kOctreeBits
    std::uint32_t threshold = 1;  ///< a cell with fewer triangles is not divided; 1 at least
    format::SplitRule rule = format::SplitRule::median;
    /// The model's frame, where boxes are to be made: in it they are stored.
    std::optional<Frame> boxes_in{};
};

/// Bytes that a build takes beside its result, at most.
inline constexpr std::uint64_t kAdaptiveScratchPerTriangle = 56;  ///< of the input
inline constexpr std::uint64_t kAdaptiveScratchPerReference = 16;
inline constexpr std::uint64_t kAdaptiveScratchPerNode = 400;

/// Builds it, as build_octree() does: closed cells, exact membership, degenerate triangles
/// as the segment or point they are, the same bytes for any parallel_for and any processor.
/// The root is the box of all corners.
///
/// Median: along each axis that of the middles of the triangles' boxes, as far as these lie in
/// the cell; the cell's own middle where that is on its border, because most of the
/// triangles lie flat on it. Surface area: of the 15 planes between 16 slices of equal width
/// the one with the least sum, over both sides, of area times triangles.
///
/// An axis along which the plane would cut every triangle's box is not divided, unless that
/// is so of all three; a cell is a leaf when no plane is inside it, or when every child would
/// have all of its triangles. So equal triangles, and those that meet in one point, end the
/// division early. A level whose division would give the tree more references than
/// build_octree() allows is not divided, nor is any below.
///
/// O(levels * references). Memory beside the result, on one thread, is at most
/// kAdaptiveScratchPerTriangle, PerReference and PerNode times what the result has of each;
/// on several, medians in work at once take up to 24 bytes a reference. Throws nothing but
/// std::bad_alloc.
[[nodiscard]] AdaptiveOctree build_adaptive_octree(std::span<const format::Double3> positions,
                                                   std::span<const format::Triangle> triangles,
                                                   const AdaptiveOctreeOptions& options = {});

}  // namespace cdprep::build
