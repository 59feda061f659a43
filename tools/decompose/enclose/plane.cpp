// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/plane.h"

#include <cmath>

#include "mesh/exact_volume.h"

namespace cdprep::convex {
namespace {

/// A normal that is shorter than the sizes of its products by more than this factor is computed
/// exactly. Let u = 2^-53. A rounded component is off by at most 5u of the sizes of its two
/// products (face_planes.cpp), so a longer normal has turned by less than 320u, or 4e-14.
constexpr double kMostCancelled = 64;

/// Returns the sum of the sizes of all products in a cross product.
double sizes_of(const Double3& u, const Double3& v) {
    return std::fabs(u.y * v.z) + std::fabs(u.z * v.y) + std::fabs(u.z * v.x) +
           std::fabs(u.x * v.z) + std::fabs(u.x * v.y) + std::fabs(u.y * v.x);
}

/// Returns the cross product (b - a) x (c - a) = a x b + b x c + c x a along an axis, divided by 6.
/// Only the result is rounded.
double exact_component(const Double3& axis, const Double3& a, const Double3& b, const Double3& c) {
    mesh::ExactVolume sum;
    sum.add(axis, a, b);
    sum.add(axis, b, c);
    sum.add(axis, c, a);
    return sum.volume();
}

/// Returns a normal whose largest component is 1 in size; 0 if it underflows.
Double3 exact_normal(const Double3& a, const Double3& b, const Double3& c) {
    const Double3 normal = {exact_component({1, 0, 0}, a, b, c),
                            exact_component({0, 1, 0}, a, b, c),
                            exact_component({0, 0, 1}, a, b, c)};
    const double largest = mesh::largest_of(normal);
    if (largest == 0) return normal;
    return {normal.x / largest, normal.y / largest, normal.z / largest};
}

}  // namespace

Plane exact_plane(const Double3& a, const Double3& b, const Double3& c) {
    const Double3 ab = mesh::minus(b, a);
    const Double3 ac = mesh::minus(c, a);
    Double3 n = mesh::cross(ab, ac);
    double length = std::sqrt(mesh::dot(n, n));
    // If the squares underflow, the length is too short as well.
    if (!(kMostCancelled * length >= sizes_of(ab, ac)) || length == 0) {
        n = exact_normal(a, b, c);
        length = std::sqrt(mesh::dot(n, n));
    }
    if (!(length > 0)) return {{0, 0, 0}, 0};
    const Double3 unit = {n.x / length, n.y / length, n.z / length};
    return {unit, mesh::dot(unit, a)};
}

}  // namespace cdprep::convex
