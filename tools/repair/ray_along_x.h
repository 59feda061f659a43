// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cdprep/exact/winding.h"

namespace cdprep::mesh {

/// Returns winding_term() of the ray from p along +x. Exact. Most triangles take no exact signs,
/// because the ray, perturbed or not, is far from their box.
[[nodiscard]] inline WindingTerm winding_term_along_x(const Double3& p, const Corners& t) {
    const auto misses = [](double a, double b, double c, double at) {
        return std::min({a, b, c}) > at || std::max({a, b, c}) < at;
    };
    if (misses(t[0].y, t[1].y, t[2].y, p.y) || misses(t[0].z, t[1].z, t[2].z, p.z) ||
        std::max({t[0].x, t[1].x, t[2].x}) < p.x) {
        return {0, false};
    }
    // If p.x is the lowest double, the ray runs in direction -x, where it meets nothing.
    constexpr double kLowest = std::numeric_limits<double>::lowest();
    const double before = std::max(p.x - 1 - 2 * std::abs(p.x), kLowest);
    return exact::winding_term({before < p.x ? before : 0, p.y, p.z}, p, t);
}

}  // namespace cdprep::mesh
