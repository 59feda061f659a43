// SPDX-License-Identifier: MIT
#include "exact/point_triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exact/powers_of_two.h"
#include "exact/vectors.h"

// All work is relative to q. A power of two scales it so that the largest corner coordinate is
// about 1. Let u = 2^-53 and let M be the largest |corner - q|.
//
// Every candidate is a point of the triangle, off by less than 8 u M. It is a combination of the
// corners with weights that are not negative and add up to 1. So its distance is an upper bound
// within 16 u M, even if the weights themselves are inaccurate. The lower bound accounts for errors
// of the weights.
//
// Edges. One projection gives the place along the edge within a few u M, and the distance within
// 16 u M.
//
// Face. Let n = (b - a) x (c - a) and let L be the longest edge. n is off by at most 8 u L^2, or
// 8 u L^2 / |n| in relative terms. That tilts the plane by as much. The foot's places along the
// edges are relative to an end of each. So the product has the edge and not two far corners. They
// are off by that tilt and 8 u M. Both together stay below eta = 64 u M (1 + L^2 / |n|). A foot
// that is wrongly classified as inside or outside is within eta of an edge. Then the distance of
// the other candidate is right within eta.
//
// Support. For any p, the triangle lies beyond the plane through the corner that is least in p's
// direction. So min(corner . p) / |p| is a lower bound, and it is tight when p is near the nearest
// point. Its products, sum, division and the corners themselves are off by at most 8 u M. Near the
// surface, p's direction is not known well enough, and the bounds above are better.
//
// Slivers. The lower bound omits the face where eta exceeds the inradius |n| / perimeter. Every
// point of the face is within the inradius of an edge.

namespace cdprep {
namespace {

constexpr double kUnit = 0x1p-53;
constexpr double kCandidateError = 16 * kUnit;
constexpr double kFaceError = 64 * kUnit;
constexpr double kSupportError = 8 * kUnit;
constexpr double kLeastSquarable = 0x1p-400;

using Vector = Double3;

struct Nearest {
    Vector point;
    double distance;
};

/// Returns the point of the segment nearest to the origin.
Nearest nearest_on_edge(const Vector& a, const Vector& b) {
    const Vector edge = b - a;
    const double squared = dot(edge, edge);
    const double t = squared > 0 ? std::clamp(-dot(a, edge) / squared, 0.0, 1.0) : 0.0;
    const Vector point = t <= 0.5 ? a + t * edge : b - (1 - t) * edge;
    return {point, length(point)};
}

Nearest nearest_on_edges(const Vector& a, const Vector& b, const Vector& c) {
    Nearest best = nearest_on_edge(a, b);
    for (const Nearest& edge : {nearest_on_edge(b, c), nearest_on_edge(c, a)}) {
        if (edge.distance < best.distance) best = edge;
    }
    return best;
}

/// Returns the foot of the origin if it lies inside the triangle, as computed with rounding; n is
/// the triangle's normal.
std::optional<Vector> foot_inside(const Vector& a, const Vector& b, const Vector& c,
                                  const Vector& n) {
    const double at_a = dot(n, cross(b, c - b));
    const double at_b = dot(n, cross(c, a - c));
    const double at_c = dot(n, cross(a, b - a));
    const double all = at_a + at_b + at_c;
    if (!(std::min({at_a, at_b, at_c}) >= 0 && all > 0)) return std::nullopt;
    return (at_a / all) * a + (at_b / all) * b + (at_c / all) * c;
}

/// Returns a lower bound from the plane normal to `nearest`; `farthest` is the distance of the
/// farthest corner.
double support_bound(const std::array<Vector, 3>& corner, const Nearest& nearest, double farthest) {
    if (nearest.distance < kLeastSquarable) return 0;
    const Vector& p = nearest.point;
    const double least = std::min({dot(corner[0], p), dot(corner[1], p), dot(corner[2], p)});
    return least / nearest.distance - kSupportError * farthest;
}

/// Returns the distance where a difference overflows. Halves are exact, or off by far less than the
/// bounds.
PointTriangleDistance twice_half_distance(const Double3& q, const Corners& t) noexcept {
    const PointTriangleDistance half =
        point_triangle_distance(0.5 * q, {0.5 * t[0], 0.5 * t[1], 0.5 * t[2]});
    return {2 * half.nearest, 2 * half.computed,
            std::min(2 * half.lower, std::numeric_limits<double>::max()), 2 * half.upper};
}

}  // namespace

PointTriangleDistance point_triangle_distance(const Double3& q, const Corners& t) noexcept {
    double size = 0;
    std::array<Vector, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
        corner[i] = {t[i].x - q.x, t[i].y - q.y, t[i].z - q.z};
        size = std::max(
            {size, std::fabs(corner[i].x), std::fabs(corner[i].y), std::fabs(corner[i].z)});
    }
    if (size == 0) return {q, 0, 0, 0};
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (size == kInfinity) {
        const bool all_finite =
            is_finite(q) && is_finite(t[0]) && is_finite(t[1]) && is_finite(t[2]);
        return all_finite ? twice_half_distance(q, t)
                          : PointTriangleDistance{q, kInfinity, 0, kInfinity};
    }
    const int exponent = -std::ilogb(size);
    const Scale forth(exponent), back(-exponent);
    for (Vector& v : corner) v = {forth(v.x), forth(v.y), forth(v.z)};
    const auto& [a, b, c] = corner;
    const double farthest = std::max({length(a), length(b), length(c)});
    const Vector n = cross(b - a, c - a);
    const double ab = length(b - a), bc = length(c - b), ca = length(a - c);
    const double longest = std::max({ab, bc, ca});
    const double height = length(n);

    Nearest best = nearest_on_edges(a, b, c);
    const double on_edges = best.distance;
    if (const std::optional<Vector> foot = foot_inside(a, b, c, n)) {
        if (const double distance = length(*foot); distance < on_edges) best = {*foot, distance};
    }
    const double rounding = 8 * kUnit * longest * longest;  // of n
    const double inradius = longest > 0 ? (height + rounding) / (ab + bc + ca) : 0;
    const double eta =
        height > 2 * rounding ? kFaceError * farthest * (1 + longest * longest / height) : inradius;
    const double candidate_error = kCandidateError * farthest;
    const double upper = best.distance + candidate_error;
    const double by_error =
        eta < inradius ? best.distance - eta : on_edges - candidate_error - inradius;
    const double lower = std::max(by_error, support_bound(corner, best, farthest));
    // The last factor covers the roundings of these sums. Scaling back may round a subnormal; one
    // step outwards covers that.
    const double outer = std::nextafter(back(upper * (1 + 4 * kUnit)), kInfinity);
    const double inner = std::nextafter(back(lower * (1 - 4 * kUnit)), -kInfinity);
    return {{q.x + back(best.point.x), q.y + back(best.point.y), q.z + back(best.point.z)},
            back(best.distance),
            std::max(0.0, inner),
            outer};
}

}  // namespace cdprep
