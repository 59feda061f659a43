// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/cells/build_tetra_tree.h"
#include "cells/build/cone_children.h"
#include "cells/cone_faces.h"

namespace cdprep::build {

/// Fills tree.boxes and tree.oriented from its nodes and references. `exponent` is that of
/// input.scale. O(levels * references); 240 bytes of scratch per node.
void make_tetra_boxes(const TetraInput& input, std::int32_t exponent,
                      const TetraTreeOptions& options, TetraTree& tree);

/// The centre where a tetra-tree's cones meet, and the size of the model around it.
struct TetraCentre {
    format::Double3 at;
    std::int32_t exponent;  ///< 2^exponent brings the longest side of the box between 1 and 2
};

/// Returns the rounded mean of the vertices that triangles use. It sums distances from the least
/// corner of their box. So the mean does not leave the box, does not overflow, and loses no digits
/// far from the origin. The mean is a float when all coordinates are: then nearly all differences
/// to it are exact.
[[nodiscard]] TetraCentre tetra_centre(std::span<const format::Double3> positions,
                                       std::span<const format::Triangle> triangles,
                                       ParallelFor parallel_for);

/// Bounds of the distance of something from the centre, as the sum of the coordinates within the
/// octant.
struct RadialRange {
    double least = std::numeric_limits<double>::infinity();
    double greatest = 0;

    void add(const RadialRange& other) noexcept {
        least = std::min(least, other.least);
        greatest = std::max(greatest, other.greatest);
    }
};

/// Widens the range by bounds of the part of the triangle that lies in the closed cone. The part
/// must not be empty. The bounds are proven. They are within a few units in the last place of the
/// corners' where the planes cut the part at no grazing angle. Units of `t`, which is near 1 in
/// size. The order of triangles changes nothing.
void add_part(const ConeFaces& faces, const SeenTriangle& t, RadialRange& range) noexcept;

inline constexpr std::uint32_t kMostLevelAtOnce = 3;  ///< 512 cones

/// All triangles, by the cones of one level that they touch.
struct ConeLists {
    std::unique_ptr<std::uint32_t[]> items;  ///< rising in each cone; may have kSharedReference
    std::vector<std::size_t> first;          ///< by key: start of each cone's items; then the end
    std::vector<std::uint32_t> centre;       ///< triangles that hold the centre: in no cone
};

/// Sorts the triangles into the cones of a level, at most kMostLevelAtOnce, without the lists of
/// the levels above. home[i] is the deepest cone that certainly contains triangle i, or 0. The
/// result is the same for any parallel_for. Scratch: 2 bytes per triangle, and half a byte for the
/// counts of each cone in each task. Triangles in several cones take 4 bytes for each cone that
/// they touch.
[[nodiscard]] ConeLists split_at_once(const TetraInput& input, const std::uint32_t* home,
                                      std::uint32_t level, ParallelFor parallel_for);

}  // namespace cdprep::build
