// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "cdprep/format/geometry.h"

namespace cdprep::mesh {

using format::Double3;

// Points and directions in double, rounded as written. Those of lib/exact are private to lib. In
// Eigen, the order of a sum depends on the instructions that the compiler may use.

[[nodiscard]] inline Double3 plus(const Double3& a, const Double3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] inline Double3 minus(const Double3& a, const Double3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] inline Double3 scaled(const Double3& a, double factor) {
    return {a.x * factor, a.y * factor, a.z * factor};
}
[[nodiscard]] inline double dot(const Double3& a, const Double3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// For coordinates whose squares are in the range of double.
[[nodiscard]] inline double length(const Double3& a) {
    return std::sqrt(dot(a, a));
}
/// Returns the length for any coordinates.
[[nodiscard]] inline double safe_length(const Double3& a) {
    return std::hypot(a.x, a.y, a.z);
}
[[nodiscard]] inline Double3 cross(const Double3& a, const Double3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Returns the middle of two points. Does not overflow.
[[nodiscard]] inline Double3 middle_of(const Double3& a, const Double3& b) {
    return {a.x / 2 + b.x / 2, a.y / 2 + b.y / 2, a.z / 2 + b.z / 2};
}
[[nodiscard]] inline double squared_distance(const Double3& a, const Double3& b) {
    const Double3 ab = minus(a, b);
    return dot(ab, ab);
}
/// For coordinates whose squares are in the range of double; distance_between() of close_groups.h
/// takes any.
[[nodiscard]] inline double euclidean_distance(const Double3& a, const Double3& b) {
    return std::sqrt(squared_distance(a, b));
}
/// Returns the mean of one or more points.
[[nodiscard]] inline Double3 mean_of(std::span<const Double3> points) {
    const double share = 1.0 / static_cast<double>(points.size());
    Double3 sum = {0, 0, 0};
    for (const Double3& p : points) {
        sum = {sum.x + p.x * share, sum.y + p.y * share, sum.z + p.z * share};
    }
    return sum;
}
/// Returns whether all coordinates are finite. 0 times infinity or NaN is NaN, which a sum keeps.
[[nodiscard]] inline bool is_finite(const Double3& a) {
    return (a.x * 0 + a.y * 0) + a.z * 0 == 0;
}
[[nodiscard]] inline double largest_of(const Double3& a) {
    return std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)});
}

// The same for arrays of three coordinates, of numbers that are exact or intervals. The analyser
// does not understand the reference counts of CGAL::Lazy_exact_nt.
// NOLINTBEGIN(clang-analyzer-cplusplus.NewDeleteLeaks)
template <class Number>
[[nodiscard]] std::array<Number, 3> plus(const std::array<Number, 3>& a,
                                         const std::array<Number, 3>& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class Number>
[[nodiscard]] std::array<Number, 3> minus(const std::array<Number, 3>& a,
                                          const std::array<Number, 3>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
[[nodiscard]] Number dot(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
[[nodiscard]] std::array<Number, 3> cross(const std::array<Number, 3>& a,
                                          const std::array<Number, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// NOLINTEND(clang-analyzer-cplusplus.NewDeleteLeaks)

}  // namespace cdprep::mesh
