// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/tetra_tree.h"

namespace cdprep::build {

/// A tetra-tree, as format/tetra_tree.h has it.
struct TetraTree {
    format::TetraTree tree{};
    std::vector<format::TetraNode> nodes;
    std::vector<std::uint32_t> references;
    std::vector<std::uint32_t> top;
    std::vector<format::BvhNode> boxes;          ///< with TetraBounding::boxes
    std::vector<format::OrientedNode> oriented;  ///< the same
};

struct TetraTreeOptions {
    ParallelFor parallel_for = serial_for;
    std::uint32_t level = 3;      ///< no cone has more splits above it; to kMaxTetraLevel
    std::uint32_t threshold = 1;  ///< a cone with fewer triangles is not split; 1 at least
    format::TetraBounding bounding = format::TetraBounding::caps;
    std::int32_t frame_exponent = 0;  ///< of the model's frame: the unit of radii
    format::Double3 frame_origin{};   ///< of the same: where boxes count from
};

/// Builds it over triangles of finite positions of at most format::kMaxCoordinate;
/// references are their numbers in `triangles` (a model's: tree order). A triangle is
/// listed in every leaf whose closed cone it touches, exactly; those that hold the
/// centre in none. Deterministic: the same bytes for any parallel_for and processor.
///
/// The centre is the mean of the vertices that triangles use, rounded to float where all
/// their coordinates are floats: so nearly all differences to it are exact. Radii hold the
/// parts of triangles in exact arithmetic; that takes a frame exponent that brings the model
/// near 1, else they may be infinite. So do boxes, in a frame that holds the model. TetraTreeFlags
/// are found along one ray.
///
/// As of build_octree(), a level whose split would give the tree more than
/// kMostFreeReferences and kMostReferencesPerTriangle for each triangle (build_octree.h) is
/// not split, nor is any below. O(levels * references). Scratch, at most: 21 bytes a vertex,
/// 7 a triangle, and for each reference of the result 13, for each node 160, with boxes 460. Throws
/// nothing but std::bad_alloc.
[[nodiscard]] TetraTree build_tetra_tree(std::span<const format::Double3> positions,
                                         std::span<const format::Triangle> triangles,
                                         const TetraTreeOptions& options = {});

}  // namespace cdprep::build
