// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "cdprep/exact/predicates.h"

namespace cdprep {

/// An axis-aligned box in double precision.
struct Box3 {
    Double3 lower;
    Double3 upper;
};

/// Returns whether two boxes overlap. Closed: touching boxes overlap.
inline bool overlap(const Box3& a, const Box3& b) noexcept {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
           b.lower.y <= a.upper.y && a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

/// Returns the widest gap between two boxes along an axis; each difference is rounded once. It is a
/// lower bound of the distance between their contents, up to that rounding. Negative where the
/// boxes overlap along all three axes.
inline double axis_gap(const Box3& a, const Box3& b) noexcept {
    return std::max({a.lower.x - b.upper.x, b.lower.x - a.upper.x, a.lower.y - b.upper.y,
                     b.lower.y - a.upper.y, a.lower.z - b.upper.z, b.lower.z - a.upper.z});
}

/// Returns whether the box contains p. Closed: points of the boundary count.
inline bool holds(const Box3& box, const Double3& p) noexcept {
    return overlap(box, {p, p});
}

inline Box3 box_around(const Corners& t) noexcept {
    const auto& [a, b, c] = t;
    return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
            {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}};
}

}  // namespace cdprep
