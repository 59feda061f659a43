// SPDX-License-Identifier: MIT
#pragma once

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

/// An octree with a split point chosen for each divided node (format/octree.h).
struct AdaptiveOctree {
    format::AdaptiveOctree tree{};
    std::vector<format::AdaptiveOctreeNode> nodes;
    std::vector<std::uint32_t> references;
    std::vector<format::CellBox> boxes;  ///< around the contents of the nodes
};

struct AdaptiveOctreeOptions {
    ParallelFor parallel_for = serial_for;
    std::uint32_t level = 3;      ///< no cell is deeper; 0 to format::kOctreeBits
    std::uint32_t threshold = 1;  ///< a cell with fewer triangles is not divided; at least 1
    format::SplitRule rule = format::SplitRule::median;
    /// The model's frame, if boxes are to be built. They are stored in frame coordinates.
    std::optional<Frame> boxes_in{};
};

/// Upper bounds of the scratch memory of a build, in bytes.
inline constexpr std::uint64_t kAdaptiveScratchPerTriangle = 56;  ///< of the input
inline constexpr std::uint64_t kAdaptiveScratchPerReference = 16;
inline constexpr std::uint64_t kAdaptiveScratchPerNode = 400;

/// Builds the octree with the rules of build_octree(): closed cells and exact membership.
/// Degenerate triangles count as the segment or point that they are. The result is the same, byte
/// for byte, for any parallel_for and processor. The root is the bounding box of all triangles.
///
/// SplitRule::median: the triangles' boxes are clipped to the cell. Along each axis, the plane is
/// at the median of the clipped boxes' centres. If the median is on the cell's boundary, the plane
/// is in the middle of the cell. This happens if most triangles lie flat on the boundary.
/// SplitRule::surface_area: along each axis, the plane is one of the 15 between 16 slices of equal
/// width. The chosen plane has the least sum, over both sides, of surface area times number of
/// triangles.
///
/// An axis is not divided if its plane would cut every triangle's box, unless that holds for all
/// three axes. A cell is a leaf if, along every axis, no double is strictly between its bounds. It
/// is also a leaf if each child would list all of the cell's triangles or none. So a cell whose
/// triangles are all equal is not divided. A level and those below it are not divided if the tree
/// would get more references than build_octree() allows.
///
/// Takes O(levels * references) time. On one thread, scratch memory is at most
/// kAdaptiveScratchPerTriangle * triangles + kAdaptiveScratchPerReference * references +
/// kAdaptiveScratchPerNode * nodes bytes, plus a few KiB. References and nodes are those of the
/// result. On several threads, medians that are computed at the same time take up to 24 bytes per
/// reference more. Throws only std::bad_alloc.
[[nodiscard]] CDPREP_API AdaptiveOctree build_adaptive_octree(
    std::span<const format::Double3> positions, std::span<const format::Triangle> triangles,
    const AdaptiveOctreeOptions& options = {});

}  // namespace cdprep::build
