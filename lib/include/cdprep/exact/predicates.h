// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "cdprep/format/api.h"
#include "cdprep/format/geometry.h"

namespace cdprep {

using format::Double3;

/// A point of a coordinate plane.
struct Double2 {
    double x, y;
};

/// The three corners of a triangle. Collinear and equal corners are allowed: the triangle is then
/// the segment or the point that they span.
using Corners = std::array<Double3, 3>;

}  // namespace cdprep

/// Exact geometric tests for offline programs: hulls, repair, studies. The signs and answers are
/// those of real arithmetic on the given doubles. All coordinates must be finite. Each function
/// sets the default floating-point environment for its duration and restores the caller's. None
/// allocates.
namespace cdprep::exact {

/// Returns the sign, -1, 0 or 1, of det[a-c, b-c]: positive when a, b, c turn
/// counter-clockwise. Takes nanoseconds; microseconds at worst.
///
/// Tries in turn a filter in double, a test for equal points, fixed-width integers, expansions
/// (Shewchuk 1997) and big integers.
[[nodiscard]] CDPREP_API int orient2d(const Double2& a, const Double2& b,
                                      const Double2& c) noexcept;

/// Returns the sign, -1, 0 or 1, of det[a-d, b-d, c-d]. It is positive when d lies behind the plane
/// of a, b and c. The front is the side from which a, b, c turn counter-clockwise. Cost and stages
/// are those of orient2d().
[[nodiscard]] CDPREP_API int orient3d(const Double3& a, const Double3& b, const Double3& c,
                                      const Double3& d) noexcept;

/// Returns orient3d(plane[0], plane[1], plane[2], p) for each of three points p; faster than three
/// calls.
[[nodiscard]] CDPREP_API std::array<int, 3> plane_signs(
    const Corners& plane, const std::array<Double3, 3>& points) noexcept;

/// The plane through three points, prepared for tests of many other points.
class Plane {
public:
    CDPREP_API Plane(const Double3& a, const Double3& b, const Double3& c) noexcept;

    /// Returns orient3d(a, b, c, p), exactly: negative when p lies in front.
    [[nodiscard]] CDPREP_API int side(const Double3& p) const noexcept;

    /// Returns the height of p in front of the plane times the length of the plane's normal,
    /// rounded.
    [[nodiscard]] CDPREP_API double height(const Double3& p) const noexcept;

private:
    Double3 a_, b_, c_;
    Double3 normal_;
    Double3 most_;  ///< the largest |difference| of the three points along each axis
};

}  // namespace cdprep::exact
