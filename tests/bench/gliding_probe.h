// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "cdprep/points.h"
#include "cdprep/pose.h"

// The walk of a haptic probe: a small ball glides over a large model, 1 mm a step. A normalised
// model, of a diagonal of 1, counts as 250 mm long.

namespace cdprep {

inline constexpr double kGlideStep = 0.004;   ///< 1 mm
inline constexpr double kProbeRadius = 0.02;  ///< 5 mm

inline Double3 plus(const Double3& p, double by, const Double3& d) {
    return {p.x + by * d.x, p.y + by * d.y, p.z + by * d.z};
}

inline Double3 unit(const Double3& v) {
    const double length = std::hypot(v.x, v.y, v.z);
    return length > 0 ? Double3{v.x / length, v.y / length, v.z / length} : Double3{1, 0, 0};
}

/// Returns the places of the probe. Its centre stays about its radius above the nearest point of
/// the surface, so that most steps touch.
inline std::vector<Double3> glide(const Model& model, std::size_t steps) {
    Workspace workspace;
    std::mt19937 random(8);
    std::normal_distribution<double> side;
    Double3 at = {0.6, 0, 0}, along = {0, 1, 0};
    std::vector<Double3> centres;
    for (std::size_t i = 0; i < steps; ++i) {
        const auto near = closest_point(model, at, workspace);
        const Double3 up = unit(plus(at, -1, near->point));
        const double height = kProbeRadius * (1 + 0.03 * std::sin(0.11 * static_cast<double>(i)));
        centres.push_back(plus(near->point, height, up));
        along = unit(plus(along, 0.2, {side(random), side(random), side(random)}));
        const double rise = along.x * up.x + along.y * up.y + along.z * up.z;
        along = unit(plus(along, -rise, up));
        at = plus(centres.back(), kGlideStep, along);
    }
    return centres;
}

/// Moves the probe to a place, without turning it.
inline Placement placed_at(const Double3& c) {
    return Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, c.x, c.y, c.z}).value());
}

}  // namespace cdprep
