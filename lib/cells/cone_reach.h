// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "cells/cone_faces.h"

namespace cdprep {

/// How near to the centre and how far from it some points surely are, as the sum of the
/// coordinates within the octant: no more than there is.
struct ConeReach {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();

    void add(const ConeReach& other) noexcept {
        least = std::min(least, other.least);
        greatest = std::max(greatest, other.greatest);
    }
};

/// Adds points of the triangle that surely lie in the closed cone: corners that do, and of
/// what the cone's planes leave of it, the corners but for a millionth of its size. Nothing
/// where rounding might take them out of the cone. Units of `t`.
void add_reach(const ConeFaces& faces, const SeenTriangle& t, ConeReach& reach) noexcept;

}  // namespace cdprep
