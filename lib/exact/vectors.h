// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "cdprep/format/geometry.h"

namespace cdprep {

using format::Double3;

// Points and directions in double; every operation is rounded in the order written. lib links no
// library for them.

inline Double3 operator-(const Double3& a) noexcept {
    return {-a.x, -a.y, -a.z};
}
inline Double3 operator+(const Double3& a, const Double3& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Double3 operator-(const Double3& a, const Double3& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Double3 operator*(double s, const Double3& a) noexcept {
    return {s * a.x, s * a.y, s * a.z};
}
inline double dot(const Double3& a, const Double3& b) noexcept {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
inline Double3 cross(const Double3& a, const Double3& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// For coordinates whose squares are in the range of double.
inline double length(const Double3& a) noexcept {
    return std::sqrt(dot(a, a));
}
inline double largest_of(const Double3& a) noexcept {
    return std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)});
}
inline bool is_finite(const Double3& a) noexcept {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
/// Returns the sum of the magnitudes of the terms of dot().
inline double dot_size(const Double3& a, const Double3& b) noexcept {
    return (std::fabs(a.x * b.x) + std::fabs(a.y * b.y)) + std::fabs(a.z * b.z);
}

// The same for arrays of three coordinates.

inline std::array<double, 3> minus(const std::array<double, 3>& a,
                                   const std::array<double, 3>& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) noexcept {
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
inline std::array<double, 3> cross(const std::array<double, 3>& a,
                                   const std::array<double, 3>& b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace cdprep
