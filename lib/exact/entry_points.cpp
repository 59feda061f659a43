// SPDX-License-Identifier: MIT
// The public functions of this folder: each calls the private one in the default floating-point
// environment. Queries call the private functions, which are inline where that is faster.
#include <algorithm>
#include <cmath>

#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"
#include "cdprep/exact/winding.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/precondition.h"
#include "exact/exact_within.h"
#include "exact/point_triangle_distance.h"
#include "exact/predicates.h"
#include "exact/triangle_contact.h"
#include "exact/vectors.h"
#include "exact/winding.h"

namespace cdprep::exact {

using format::FloatEnvironment;

int orient2d(const Double2& a, const Double2& b, const Double2& c) noexcept {
    const FloatEnvironment environment;
    return cdprep::orient2d(a, b, c);
}

int orient3d(const Double3& a, const Double3& b, const Double3& c, const Double3& d) noexcept {
    const FloatEnvironment environment;
    return cdprep::orient3d(a, b, c, d);
}

std::array<int, 3> plane_signs(const Corners& plane,
                               const std::array<Double3, 3>& points) noexcept {
    const FloatEnvironment environment;
    return cdprep::plane_signs(plane, points);
}

Plane::Plane(const Double3& a, const Double3& b, const Double3& c) noexcept : a_(a), b_(b), c_(c) {
    const FloatEnvironment environment;
    const Double3 u = b - a, v = c - a;
    normal_ = cross(u, v);
    most_ = {std::max(std::fabs(u.x), std::fabs(v.x)), std::max(std::fabs(u.y), std::fabs(v.y)),
             std::max(std::fabs(u.z), std::fabs(v.z))};
}

double Plane::height(const Double3& p) const noexcept {
    const FloatEnvironment environment;
    return dot(normal_, p - a_);
}

int Plane::side(const Double3& p) const noexcept {
    const FloatEnvironment environment;
    const Double3 w = p - a_;
    // As plane_signs(), for one point at a time; its normal has the opposite direction.
    const int sign =
        filtered_sign(dot(normal_, w), std::max(most_.x, std::fabs(w.x)),
                      std::max(most_.y, std::fabs(w.y)), std::max(most_.z, std::fabs(w.z)));
    return sign == 2 ? orient3d_beyond_filter(a_, b_, c_, p) : -sign;
}

bool triangles_touch(const Corners& a, const Corners& b) noexcept {
    const FloatEnvironment environment;
    return cdprep::triangles_touch(a, b);
}

TriangleContact classify_contact(const Corners& a, const Corners& b) noexcept {
    const FloatEnvironment environment;
    return cdprep::classify_contact(a, b);
}

TriangleContact contact_without_filter(const Corners& a, const Corners& b) noexcept {
    const FloatEnvironment environment;
    return contact_beyond_filter(a, b);
}

std::optional<CrossingEnds> crossing_ends(const Corners& a, const Corners& b) noexcept {
    const FloatEnvironment environment;
    return cdprep::crossing_ends(a, b);
}

bool is_degenerate(const Corners& t) noexcept {
    const FloatEnvironment environment;
    return cdprep::is_degenerate(t);
}

PointTriangleDistance point_triangle_distance(const Double3& q, const Corners& t) noexcept {
    const FloatEnvironment environment;
    return cdprep::point_triangle_distance(q, t);
}

bool is_within(std::span<const Double3> corners, const Corners& t, double distance) noexcept {
    if (corners.empty() || corners.size() > 3) {
        stop_with("A point, segment or triangle for exact::is_within() has 1 to 3 corners.");
    }
    const FloatEnvironment environment;
    return is_within_exactly(corners, t, distance);
}

WindingTerm winding_term(const Double3& o, const Double3& q, const Corners& t) noexcept {
    const FloatEnvironment environment;
    return cdprep::winding_term(o, q, t);
}

Double3 before_along_x(const Double3& q, double reach) noexcept {
    const FloatEnvironment environment;
    return cdprep::before_along_x(q, reach);
}

}  // namespace cdprep::exact
