// SPDX-License-Identifier: MIT
#pragma once

#include "exact/triangle_contact.h"

namespace cdprep {

/// The distance of two triangles, as an interval with two witnesses.
struct TriangleDistance {
    double lower;  ///< a lower bound of the distance
    double upper;  ///< an upper bound; the points are at most this far apart, up to rounding
    Double3 on_a;
    Double3 on_b;
};

/// Returns the distance of two triangles that do not touch. For two that touch, `lower` is 0 and
/// `upper` any bound. Corners may be collinear or equal. Computes in double. If `tight` is set and
/// the interval is wider than 1e-12 of its lower bound, computes again in twice the precision.
[[nodiscard]] TriangleDistance triangle_distance(const Corners& a, const Corners& b,
                                                 bool tight) noexcept;

/// Returns whether the interval is narrow enough not to be computed again with `tight`.
[[nodiscard]] inline bool is_tight(const TriangleDistance& found) noexcept {
    constexpr double kTightness = 1e-12;
    return found.upper - found.lower <= kTightness * found.lower;
}

/// Returns a common point of both triangles, up to rounding: each is within 2^-46 of the largest
/// coordinate. Requires that they touch. Takes some 300 ns, and microseconds where double would be
/// farther off.
[[nodiscard]] Double3 common_point(const Corners& a, const Corners& b) noexcept;

}  // namespace cdprep
