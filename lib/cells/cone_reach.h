// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "cells/cone_faces.h"

namespace cdprep {

/// The least and greatest distance from the centre that some points certainly attain, as the sum of
/// the coordinates within the octant. The true range is never narrower.
struct ConeReach {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();

    void add(const ConeReach& other) noexcept {
        least = std::min(least, other.least);
        greatest = std::max(greatest, other.greatest);
    }
};

/// Adds points of the triangle that certainly lie in the closed cone. These are corners that do,
/// and the corners of what the cone's planes leave of the triangle. The latter are moved inwards by
/// a millionth of its size. Adds nothing where rounding might move points out of the cone. Units of
/// `t`.
void add_reach(const ConeFaces& faces, const SeenTriangle& t, ConeReach& reach) noexcept;

}  // namespace cdprep
