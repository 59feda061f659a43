// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/convex_hull.h"

#include "hull/cull_inside.h"
#include "hull/exact_hull.h"

namespace cdprep::convex {

ConvexHull convex_hull(std::span<const Double3> points, ParallelFor run) {
    const std::vector<std::uint32_t> outer = cull_inside(points, run);
    if (outer.size() == points.size()) return exact_hull(points);
    std::vector<Double3> kept;
    kept.reserve(outer.size());
    for (const std::uint32_t number : outer) kept.push_back(points[number]);
    ConvexHull hull = exact_hull(kept);
    for (std::uint32_t& number : hull.numbers) number = outer[number];
    return hull;
}

}  // namespace cdprep::convex
