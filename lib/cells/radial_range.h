// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "cells/cone_faces.h"

namespace cdprep::build {

/// How far out from the centre something is, as the sum of the coordinates within the
/// octant: bounds.
struct RadialRange {
    double least = std::numeric_limits<double>::infinity();
    double greatest = 0;

    void add(const RadialRange& other) noexcept {
        least = std::min(least, other.least);
        greatest = std::max(greatest, other.greatest);
    }
};

/// Widens the range by bounds of the part of the triangle that lies in the closed cone,
/// which some does: proven, and within a few units in the last place of the corners' where
/// the planes cut it at no grazing angle. Units of `t`, which is near 1 in size. The order
/// in which triangles come changes nothing.
void add_part(const ConeFaces& faces, const SeenTriangle& t, RadialRange& range) noexcept;

}  // namespace cdprep::build
