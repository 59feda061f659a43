// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "cdprep/exact/predicates.h"
#include "cdprep/format/api.h"

namespace cdprep {

/// Returns the sign, -1, 0 or 1, of det[a-c, b-c]: positive when a, b, c turn counter-clockwise.
/// Exact for all finite inputs, subnormals included. Never allocates.
[[nodiscard]] int orient2d(const Double2& a, const Double2& b, const Double2& c) noexcept;

/// Returns the sign, -1, 0 or 1, of det[a-d, b-d, c-d]. It is positive when d lies behind the
/// plane, seen from the side where a, b, c turn counter-clockwise. Exact for all finite inputs,
/// subnormals included. Never allocates.
///
/// A semi-static filter decides most calls in a few nanoseconds. Equal points, machine integers,
/// expansions of the differences and wide integers decide the rest, in this order.
[[nodiscard]] inline int orient3d(const Double3& a, const Double3& b, const Double3& c,
                                  const Double3& d) noexcept;

/// Returns orient3d(plane[0], plane[1], plane[2], p) for three points p; computes the plane's
/// normal once.
[[nodiscard]] inline std::array<int, 3> plane_signs(const Corners& plane,
                                                    const Corners& points) noexcept;

/// Does the part of orient3d() where its filter cannot decide; for orient3d() only.
[[nodiscard]] CDPREP_API int orient3d_beyond_filter(const Double3& a, const Double3& b,
                                                    const Double3& c, const Double3& d) noexcept;

// The filter. Let u = 2^-53, and let M be the product of the largest |difference| per axis. Each
// rounded difference is off by a factor of 1 + u, and each product of two by 1 + 3u. Each of the
// three minors is at most 2 M / m, with m the largest of the third axis. So it is off by
// 2 (3u) + 2u for its subtraction: 8u M / m. Times a difference, 2u for the difference and 2u for
// the product are added to 8u: 12u M per term, 36u M for three. The first sum, at most 4 M, adds
// 4u M, the second 6u M. The total is 46u M and terms in u^2. The constant, 46.03u, covers these
// and the roundings of M itself. Underflow changes the determinant by at most 2^-1070 times the
// largest difference m. The limits keep M above (1e-97)^2 m, and every number finite.
inline constexpr double kFilter3d = 5.1107127829973299e-15;
inline constexpr double kLeastForFilter3d = 1e-97;
inline constexpr double kLargestForFilter3d = 1e102;

/// Returns the sign of `determinant`, or 2 when rounding may have changed it. x, y and z are the
/// largest |difference| per axis.
[[nodiscard]] inline int filtered_sign(double determinant, double x, double y, double z) noexcept {
    const double bound = kFilter3d * x * y * z;
    const double least = std::min(std::min(x, y), z);
    const double most = std::max(std::max(x, y), z);
    if (least >= kLeastForFilter3d && most < kLargestForFilter3d) {
        if (determinant > bound) return 1;
        if (determinant < -bound) return -1;
    }
    // A flat axis: gradual underflow makes differences of unequal numbers non-zero, so a largest
    // difference of 0 is exact.
    return least == 0 ? 0 : 2;
}

inline double largest_of(double a, double b, double c) noexcept {
    return std::max(std::max(std::fabs(a), std::fabs(b)), std::fabs(c));
}

/// Returns orient3d(), or 2 when the filter cannot decide.
inline int filtered_orient3d(const Double3& a, const Double3& b, const Double3& c,
                             const Double3& d) noexcept {
    const double ax = a.x - d.x, ay = a.y - d.y, az = a.z - d.z;
    const double bx = b.x - d.x, by = b.y - d.y, bz = b.z - d.z;
    const double cx = c.x - d.x, cy = c.y - d.y, cz = c.z - d.z;
    const double determinant =
        ax * (by * cz - bz * cy) + bx * (cy * az - cz * ay) + cx * (ay * bz - az * by);
    return filtered_sign(determinant, largest_of(ax, bx, cx), largest_of(ay, by, cy),
                         largest_of(az, bz, cz));
}

inline int orient3d(const Double3& a, const Double3& b, const Double3& c,
                    const Double3& d) noexcept {
    const int sign = filtered_orient3d(a, b, c, d);
    return sign != 2 ? sign : orient3d_beyond_filter(a, b, c, d);
}

/// Returns plane_signs(), with 2 where the filter cannot decide.
inline std::array<int, 3> filtered_plane_signs(const Corners& plane,
                                               const Corners& points) noexcept {
    const auto& [a, b, c] = plane;
    const double bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
    const double cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
    // The opposite normal: orient3d is positive behind the plane.
    const double nx = bz * cy - by * cz, ny = bx * cz - bz * cx, nz = by * cx - bx * cy;
    const double mx = std::max(std::fabs(bx), std::fabs(cx));
    const double my = std::max(std::fabs(by), std::fabs(cy));
    const double mz = std::max(std::fabs(bz), std::fabs(cz));
    std::array<int, 3> signs;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3& p = points[i];
        const double x = p.x - a.x, y = p.y - a.y, z = p.z - a.z;
        signs[i] = filtered_sign(nx * x + ny * y + nz * z, std::max(mx, std::fabs(x)),
                                 std::max(my, std::fabs(y)), std::max(mz, std::fabs(z)));
    }
    return signs;
}

inline std::array<int, 3> plane_signs(const Corners& plane, const Corners& points) noexcept {
    std::array<int, 3> signs = filtered_plane_signs(plane, points);
    for (std::size_t i = 0; i < 3; ++i) {
        if (signs[i] != 2) continue;
        signs[i] = orient3d_beyond_filter(plane[0], plane[1], plane[2], points[i]);
    }
    return signs;
}

}  // namespace cdprep
