// SPDX-License-Identifier: MIT
#pragma once

#include "cone_faces.h"

namespace cdprep::build {

/// How far out from the centre, as the sum of the coordinates within the octant.
struct RadialRange {
    double least;
    double greatest;
};

/// Returns bounds of the part of the triangle that lies in the closed cone, which some
/// does: proven, and within a few units in the last place of the corners' where the
/// planes cut it at no grazing angle. Units of `t`, which is near 1 in size.
[[nodiscard]] RadialRange radial_range(const ConeFaces& faces, const SeenTriangle& t) noexcept;

}  // namespace cdprep::build
