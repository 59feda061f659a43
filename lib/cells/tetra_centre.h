// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/cells/build_tetra_tree.h"

namespace cdprep::build {

/// Where a tetra-tree's cones meet, and how large the model is about it.
struct TetraCentre {
    format::Double3 at;
    std::int32_t exponent;  ///< 2^exponent brings the longest side of the box between 1 and 2
};

/// Returns the mean of the vertices that triangles use, rounded: by summing up distances
/// from the least corner of their box, so that it does not leave the box, and neither
/// overflows nor loses digits far from the origin. A float when all coordinates are:
/// then nearly all differences to it are exact.
[[nodiscard]] TetraCentre tetra_centre(std::span<const format::Double3> positions,
                                       std::span<const format::Triangle> triangles,
                                       ParallelFor parallel_for);

}  // namespace cdprep::build
