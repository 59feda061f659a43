// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/api.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/tetra_tree.h"

namespace cdprep::build {

/// A tetra-tree (format/tetra_tree.h).
struct TetraTree {
    format::TetraTree tree{};
    std::vector<format::TetraNode> nodes;
    std::vector<std::uint32_t> references;
    std::vector<std::uint32_t> top;
    std::vector<format::BvhNode> boxes;          ///< with TetraBounding::boxes
    std::vector<format::OrientedNode> oriented;  ///< with TetraBounding::boxes
};

struct TetraTreeOptions {
    ParallelFor parallel_for = serial_for;
    std::uint32_t level = 3;      ///< no cone is deeper; 0 to kMaxTetraLevel
    std::uint32_t threshold = 1;  ///< a cone with fewer triangles is not split; at least 1
    format::TetraBounding bounding = format::TetraBounding::caps;
    std::int32_t frame_exponent = 0;  ///< of the model's frame: the unit of radii
    format::Double3 frame_origin{};   ///< of the model's frame: the origin of boxes
};

/// Builds the tree over triangles. Coordinates must be finite and at most format::kMaxCoordinate in
/// magnitude. References are triangle numbers in `triangles` (in a model: tree order). Triangles
/// that contain the centre are listed in no leaf. Any other triangle is listed in exactly those
/// leaves whose closed cone it touches. The result is the same, byte for byte, for any parallel_for
/// and processor.
///
/// The centre is the mean of the vertices that triangles use. It is rounded to float if all their
/// coordinates are floats. Then nearly all differences between vertices and centre are exact. The
/// radii of a cone are rounded outwards, so they bound the exact part of its triangles in the cone.
/// Choose a frame exponent that scales the model to about 1. With a much larger exponent, radii may
/// be infinite and exclude nothing. Boxes contain the same parts and require a frame that contains
/// the model. The flag tetra_centre_inside is computed along one ray from the centre.
///
/// The number of references is limited as in build_octree(). A level whose split would exceed the
/// limit is not split, nor is any below. Takes O(levels * references) time. Uses at most 21 bytes
/// of scratch memory per vertex and 7 per triangle. It uses 13 more per reference of the result,
/// and 160 per node, or 460 with boxes. Throws only std::bad_alloc.
[[nodiscard]] CDPREP_API TetraTree build_tetra_tree(std::span<const format::Double3> positions,
                                                    std::span<const format::Triangle> triangles,
                                                    const TetraTreeOptions& options = {});

}  // namespace cdprep::build
