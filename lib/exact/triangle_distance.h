// SPDX-License-Identifier: MIT
#pragma once

#include "exact/triangle_contact.h"

namespace cdprep {

/// How far two triangles are apart.
struct TriangleDistance {
    double lower;  ///< the distance is at least this
    double upper;  ///< and at most this: the points are that near, up to rounding
    Double3 on_a;
    Double3 on_b;
};

/// Returns the distance of two triangles that do not touch; for two that do,
/// `lower` is 0 and `upper` any bound. Corners may be collinear or equal. In double,
/// and when the interval is then wider than 1e-12 of itself and `tight` is set,
/// again in twice the precision.
[[nodiscard]] TriangleDistance triangle_distance(const Corners& a, const Corners& b,
                                                 bool tight) noexcept;

/// Whether it is so narrow that it is not taken again, when `tight` is set.
[[nodiscard]] inline bool is_tight(const TriangleDistance& found) noexcept {
    constexpr double kTightness = 1e-12;
    return found.upper - found.lower <= kTightness * found.lower;
}

/// Returns a point of both triangles, up to rounding; they must touch.
[[nodiscard]] Double3 common_point(const Corners& a, const Corners& b) noexcept;

}  // namespace cdprep
