// SPDX-License-Identifier: MIT
#include "exact/triangle_distance.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "exact/double_double.h"
#include "exact/exact_common_point.h"
#include "exact/point_triangle_distance.h"
#include "exact/powers_of_two.h"
#include "exact/vectors.h"

// Two triangles that do not touch are nearest in one of two ways (Larsen, Gottschalk, Lin and
// Manocha 1999). One is at an edge of each: nine pairs with corners included. The other is at a
// corner of one and the face of the other: six pairs. All work is relative to a corner of A. A
// power of two scales it so that the largest coordinate, M, is about 1. Let e be the unit roundoff
// of the numbers in use.
//
// Every candidate is a pair of points of the triangles. Each point, off by less than 8 e M, is a
// combination of corners. Its weights are in [0, 1] and add up to 1. So their distance is an upper
// bound within 24 e M, even if the weights are inaccurate.
//
// The lower bound does not depend on the accuracy of the candidates. For any direction w, take the
// planes normal to it through A's farthest and B's nearest corner. They lie
// (min w.b - max w.a) / |w| apart, and the triangles at least as far. The dot products, the
// difference, the root and the quotient are off by 24 e M. With w between the nearest points the
// bound is tight. If w is off by an angle, the bound loses that angle times the size of a triangle.

namespace cdprep {
namespace {

constexpr double kDoubleError = 24 * 0x1p-53;
constexpr double kDoubleDoubleError = 24 * 0x1p-100;

// vectors.h has these for double only; here T is double or DoubleDouble.
template <class T>
struct Vector {
    T x, y, z;
};

template <class T>
Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Vector<T> operator+(const Vector<T>& a, const Vector<T>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Vector<T> operator*(const T& s, const Vector<T>& a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class T>
T dot(const Vector<T>& a, const Vector<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
using Triangle = std::array<Vector<T>, 3>;

// Uses selections instead of branches: the cases are unpredictable.
template <class T>
T within_unit(const T& t) {
    const T from_zero = t < T(0.0) ? T(0.0) : t;
    return from_zero > T(1.0) ? T(1.0) : from_zero;
}

/// A point of each triangle, and their squared distance.
template <class T>
struct Nearest {
    Vector<T> on_a{};
    Vector<T> on_b{};
    T squared = std::numeric_limits<double>::infinity();

    void offer(const Nearest& other) {
        if (other.squared < squared) *this = other;
    }
};

template <class T>
Nearest<T> pair_of(const Vector<T>& a, const Vector<T>& b) {
    const Vector<T> w = b - a;
    return {a, b, dot(w, w)};
}

/// The nearest points of two segments (Ericson 2005, 5.1.9), with clamping instead of branches for
/// the ends of both.
template <class T>
Nearest<T> nearest_on_edges(const Vector<T>& p, const Vector<T>& p_end, const Vector<T>& q,
                            const Vector<T>& q_end) {
    const Vector<T> u = p_end - p;
    const Vector<T> v = q_end - q;
    const Vector<T> r = p - q;
    const T uu = dot(u, u);
    const T vv = dot(v, v);
    const T uv = dot(u, v);
    const T ur = dot(u, r);
    const T vr = dot(v, r);
    const T zero(0.0);
    const T denominator = uu * vv - uv * uv;
    const T along = within_unit((uv * vr - ur * vv) / denominator);
    T s = denominator > zero ? along : zero;
    const T across = within_unit((uv * s + vr) / vv);
    const T t = vv > zero ? across : zero;
    const T back = within_unit((uv * t - ur) / uu);
    s = uu > zero ? back : zero;
    const T one(1.0);
    return pair_of((one - s) * p + s * p_end, (one - t) * q + t * q_end);
}

/// Computes the foot of p on the triangle's plane; false if it lies outside.
template <class T>
bool foot_inside(const Vector<T>& p, const Triangle<T>& t, Vector<T>& foot) {
    const Vector<T> n = cross(t[1] - t[0], t[2] - t[0]);
    const Triangle<T> d = {t[0] - p, t[1] - p, t[2] - p};
    const T at_a = dot(n, cross(d[1], t[2] - t[1]));
    const T at_b = dot(n, cross(d[2], t[0] - t[2]));
    const T at_c = dot(n, cross(d[0], t[1] - t[0]));
    const T all = at_a + at_b + at_c;
    const T zero(0.0);
    if (at_a < zero || at_b < zero || at_c < zero || !(all > zero)) return false;
    foot = (at_a / all) * t[0] + (at_b / all) * t[1] + (at_c / all) * t[2];
    return true;
}

template <class T>
Nearest<T> nearest_points(const Triangle<T>& a, const Triangle<T>& b) {
    // Compared when all are known, so no pair waits for the one before.
    std::array<Nearest<T>, 9> on_edges;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            on_edges[3 * i + j] = nearest_on_edges(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
        }
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < 9; ++i) {
        best = on_edges[i].squared < on_edges[best].squared ? i : best;
    }
    Nearest<T> nearest = on_edges[best];
    Vector<T> foot{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (foot_inside(b[i], a, foot)) nearest.offer(pair_of(foot, b[i]));
        if (foot_inside(a[i], b, foot)) nearest.offer(pair_of(a[i], foot));
    }
    return nearest;
}

/// Bounds of the scaled distance.
struct Interval {
    double lower;
    double upper;
};

template <class T>
Interval interval_of(const Triangle<T>& a, const Triangle<T>& b, const Nearest<T>& nearest,
                     double error) {
    const Vector<T> w = nearest.on_b - nearest.on_a;
    const T length = square_root(nearest.squared);
    const double upper = static_cast<double>(length) + error;
    if (!(nearest.squared > T(0x1p-800))) return {0, upper};
    T least = dot(w, b[0]);
    T greatest = dot(w, a[0]);
    for (std::size_t i = 1; i < 3; ++i) {
        const T at_b = dot(w, b[i]);
        const T at_a = dot(w, a[i]);
        if (at_b < least) least = at_b;
        if (at_a > greatest) greatest = at_a;
    }
    const double lower = static_cast<double>((least - greatest) / length) - error;
    return {std::max(0.0, lower), upper};
}

template <class T>
Triangle<T> scaled(const Corners& corners, const Double3& origin, const Scale& scale) {
    const auto at = [&](double x, double from) {
        // Scaled before the difference, which is exact. So is the difference in twice the
        // precision.
        return T(scale(x)) - T(scale(from));
    };
    Triangle<T> result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3& p = corners[i];
        result[i] = {at(p.x, origin.x), at(p.y, origin.y), at(p.z, origin.z)};
    }
    return result;
}

template <class T>
TriangleDistance measured(const Corners& a, const Corners& b, int exponent, double error) {
    const Scale scale(exponent);
    const Scale unscale(-exponent);
    const Triangle<T> at_a = scaled<T>(a, a[0], scale);
    const Triangle<T> at_b = scaled<T>(b, a[0], scale);
    const Nearest<T> nearest = nearest_points(at_a, at_b);
    const Interval interval = interval_of(at_a, at_b, nearest, error);
    const auto back = [&](const Vector<T>& p) {
        const auto moved = [&](const T& x, double from) {
            return unscale(static_cast<double>(x + T(scale(from))));
        };
        return Double3{moved(p.x, a[0].x), moved(p.y, a[0].y), moved(p.z, a[0].z)};
    };
    // Scaling back may round a subnormal; one step outwards covers that.
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double lower = std::nextafter(unscale(interval.lower), -kInfinity);
    return {std::max(0.0, lower), std::nextafter(unscale(interval.upper), kInfinity),
            back(nearest.on_a), back(nearest.on_b)};
}

/// Returns the exponent of two that brings the largest difference to about 1.
int exponent_of(const Corners& a, const Corners& b) {
    double size = 0;
    for (const Corners* corners : {&a, &b}) {
        for (const Double3& p : *corners) {
            size = std::max(
                {size, std::fabs(p.x - a[0].x), std::fabs(p.y - a[0].y), std::fabs(p.z - a[0].z)});
        }
    }
    constexpr int kBeyondDouble = -1024;
    if (size == std::numeric_limits<double>::infinity()) return kBeyondDouble;
    return size > 0 ? -std::ilogb(size) : 0;
}

/// Computes the point where the segment meets the triangle's plane; false if it lies outside.
bool crossing(const Vector<double>& p, const Vector<double>& q, const Triangle<double>& t,
              Vector<double>& point) {
    const Vector<double> n = cross(t[1] - t[0], t[2] - t[0]);
    const double at_p = dot(n, p - t[0]);
    const double at_q = dot(n, q - t[0]);
    if (!(at_p * at_q < 0)) return false;
    const double s = at_p / (at_p - at_q);
    const Vector<double> at = (1 - s) * p + s * q;
    Vector<double> foot{};
    if (!foot_inside(at, t, foot)) return false;
    point = at;
    return true;
}

/// Returns a common point, computed in double.
Double3 rounded_common_point(const Corners& a, const Corners& b) {
    const int exponent = exponent_of(a, b);
    const Scale scale(exponent);
    const Scale unscale(-exponent);
    const Triangle<double> at_a = scaled<double>(a, a[0], scale);
    const Triangle<double> at_b = scaled<double>(b, a[0], scale);
    // If the triangles cross, an edge of one pierces the other. Otherwise they touch where they are
    // nearest.
    Vector<double> point = nearest_points(at_a, at_b).on_a;
    for (std::size_t i = 0; i < 3; ++i) {
        if (crossing(at_a[i], at_a[(i + 1) % 3], at_b, point) ||
            crossing(at_b[i], at_b[(i + 1) % 3], at_a, point)) {
            break;
        }
    }
    return {a[0].x + unscale(point.x), a[0].y + unscale(point.y), a[0].z + unscale(point.z)};
}

}  // namespace

Double3 common_point(const Corners& a, const Corners& b) noexcept {
    const Double3 point = rounded_common_point(a, b);
    // Usually the point is off by less than 2^-50 of the largest coordinate. It may be far off
    // triangles that are thin or nearly coplanar. The measurement adds less than 2^-47.
    double size = 0;
    for (const Corners* t : {&a, &b}) {
        for (const Double3& p : *t) size = std::max(size, largest_of(p));
    }
    const auto is_on = [&](const Corners& t) {
        return point_triangle_distance(point, t).computed <= 0x1p-47 * size;
    };
    // Where a difference overflows, the point may be infinite or NaN.
    if (is_finite(point) && is_on(a) && is_on(b)) return point;
    return exact_common_point(a, b).value_or(point);
}

TriangleDistance triangle_distance(const Corners& a, const Corners& b, bool tight) noexcept {
    const int exponent = exponent_of(a, b);
    const TriangleDistance first = measured<double>(a, b, exponent, kDoubleError);
    assert(first.lower <= first.upper);
    if (!tight || is_tight(first)) return first;
    const TriangleDistance second = measured<DoubleDouble>(a, b, exponent, kDoubleDoubleError);
    return second.upper - second.lower < first.upper - first.lower ? second : first;
}

}  // namespace cdprep
