// SPDX-License-Identifier: MIT
#include "exact/exact_within.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "exact/box3.h"
#include "exact/point_triangle_distance.h"
#include "exact/triangle_distance.h"
#include "exact/vectors.h"
#include "exact/wide_vector.h"

// Two objects that do not touch are nearest in one of two ways. One is at a corner of one and a
// corner, edge or face of the other. The other is at an edge of each. Every such place whose feet
// lie inside is a pair of points of the two objects. So one place that is near enough proves yes.
// If there is none, the answer is no.
//
// A place is near enough when a polynomial of the coordinates is not positive. Its degree is 2 for
// corners, 4 for a corner and an edge, and 6 otherwise. All numbers are multiples of the lowest bit
// that occurs, so they are integers.

namespace cdprep {
namespace {

using Place = WidePlace;
using Length = WideInteger<kWideCoordinate>;
using Square = WideInteger<2 * kWideCoordinate>;
using Volume = WideInteger<3 * kWideCoordinate>;

template <std::size_t kLimbs>
bool at_most(const WideInteger<kLimbs>& a, const WideInteger<kLimbs>& b) noexcept {
    return (a - b).sign() <= 0;
}

/// One to three corners in integers.
struct Figure {
    std::array<Place, 3> corner;
    std::size_t count;

    [[nodiscard]] std::size_t edges() const noexcept {
        return count == 3 ? 3 : count - 1;
    }
};

bool near_corner(const Place& w, const Square& limit) noexcept {
    return at_most(dot(w, w), limit);
}

/// Tests p against the segment, ends included.
bool near_segment(const Place& p, const Place& from, const Place& to,
                  const Square& limit) noexcept {
    const Place w = p - from;
    const Place u = to - from;
    const Square along = dot(w, u);
    const Square whole = dot(u, u);
    if (along.sign() <= 0) return near_corner(w, limit);
    if (at_most(whole, along)) return near_corner(p - to, limit);
    return at_most(dot(w, w) * whole - along * along, limit * whole);
}

/// Tests p against the inside of the triangle; false unless p's foot lies in it.
bool near_face(const Place& p, const Figure& t, const Square& limit) noexcept {
    const WideVector<2 * kWideCoordinate> n =
        cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
    const auto squared = dot(n, n);
    if (squared.sign() == 0) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Place edge = t.corner[(i + 1) % 3] - t.corner[i];
        if (dot(n, cross(edge, p - t.corner[i])).sign() < 0) return false;
    }
    const Volume height = dot(n, p - t.corner[0]);
    return at_most(height * height, limit * squared);
}

/// Tests the insides of two segments; false unless the lines' nearest points lie in both.
bool near_lines(const Place& p, const Place& p_end, const Place& q, const Place& q_end,
                const Square& limit) noexcept {
    const Place u = p_end - p;
    const Place v = q_end - q;
    const Place w = p - q;
    const WideVector<2 * kWideCoordinate> n = cross(u, v);
    const auto squared = dot(n, n);
    if (squared.sign() == 0) return false;
    const Square uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const auto inside = [&](const auto& place) {
        return place.sign() >= 0 && at_most(place, squared);
    };
    if (!inside(uv * vw - uw * dot(v, v)) || !inside(dot(u, u) * vw - uv * uw)) return false;
    const Volume height = dot(n, w);
    return at_most(height * height, limit * squared);
}

/// Tests all corners of `a` against all corners, edges and the face of `b`.
bool near_any_corner(const Figure& a, const Figure& b, const Square& limit) noexcept {
    for (std::size_t i = 0; i < a.count; ++i) {
        for (std::size_t j = 0; j < b.edges(); ++j) {
            if (near_segment(a.corner[i], b.corner[j], b.corner[(j + 1) % 3], limit)) return true;
        }
        if (b.count == 1 && near_corner(a.corner[i] - b.corner[0], limit)) return true;
        if (b.count == 3 && near_face(a.corner[i], b, limit)) return true;
    }
    return false;
}

bool near_any_edges(const Figure& a, const Figure& b, const Square& limit) noexcept {
    for (std::size_t i = 0; i < a.edges(); ++i) {
        for (std::size_t j = 0; j < b.edges(); ++j) {
            if (near_lines(a.corner[i], a.corner[(i + 1) % 3], b.corner[j], b.corner[(j + 1) % 3],
                           limit)) {
                return true;
            }
        }
    }
    return false;
}

Figure figure(std::span<const Double3> points, int lowest) noexcept {
    assert(!points.empty() && points.size() <= 3);
    Figure result;
    result.count = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
        result.corner[i] = wide_place(points[i], lowest);
    }
    return result;
}

/// Returns whether the interval arithmetic of the first stage stays in range.
bool in_range(std::span<const Double3> points) noexcept {
    constexpr double kMost = 8 * format::kMaxCoordinate;
    return std::all_of(points.begin(), points.end(), [](const Double3& p) {
        return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) <= kMost;
    });
}

/// Returns whether the boxes around the two are certainly farther apart than `distance`. Each gap
/// is off by a factor of 1 + u. The sum of their squares and the square of the limit are off by
/// 1 + 8u together. Below kLeastSquare an underflow could matter.
bool boxes_are_apart(std::span<const Double3> points, const Corners& t, double distance) noexcept {
    constexpr double kRounding = 0x1p-48;
    constexpr double kLeastSquare = 0x1p-900;
    const Box3 a = box_around({points[0], points[points.size() / 2], points.back()});
    const Box3 b = box_around(t);
    const auto gap = [](double from, double to, double other_from, double other_to) {
        const double between = std::max(std::max(from - other_to, other_from - to), 0.0);
        return between * between;
    };
    const double squared = gap(a.lower.x, a.upper.x, b.lower.x, b.upper.x) +
                           gap(a.lower.y, a.upper.y, b.lower.y, b.upper.y) +
                           gap(a.lower.z, a.upper.z, b.lower.z, b.upper.z);
    return squared > kLeastSquare && squared > distance * distance * (1 + kRounding);
}

enum class Quick : std::uint8_t { no, yes, unsure };

/// Answers most queries for triangles near a point or segment. `yes`: a corner is near enough.
/// `no`: the triangle lies beyond the plane that is normal to the line from the segment to its
/// middle.
///
/// Everything is relative to an end of the segment. Let M be the largest coordinate: the
/// differences, feet and dot products with unit vectors are off by less than 64 u M.
Quick quick_answer(std::span<const Double3> points, const Corners& t, double distance) noexcept {
    if (points.size() > 2) return Quick::unsure;
    const Double3 along = points.back() - points[0];
    const Corners corner = {t[0] - points[0], t[1] - points[0], t[2] - points[0]};
    const double size = std::max(
        {largest_of(along), largest_of(corner[0]), largest_of(corner[1]), largest_of(corner[2])});
    // Within these limits squares neither underflow nor overflow.
    if (!(size > 0x1p-400 && size < 0x1p400 && distance < 0x1p400)) return Quick::unsure;
    const double margin = 64 * 0x1p-53 * (size + distance);
    const double squared = dot(along, along);
    const auto from_segment = [&](const Double3& p) {
        const double place = squared > 0 ? dot(p, along) / squared : 0;
        return p - std::min(std::max(place, 0.0), 1.0) * along;
    };
    if (const double near = distance - margin; near > 0x1p-400) {
        for (const Double3& p : corner) {
            const Double3 w = from_segment(p);
            if (dot(w, w) <= near * near) return Quick::yes;
        }
    }
    const Double3 w = from_segment((1.0 / 3) * (corner[0] + corner[1] + corner[2]));
    const double length = std::sqrt(dot(w, w));
    const double least = std::min({dot(w, corner[0]), dot(w, corner[1]), dot(w, corner[2])});
    const double gap = least - std::max(0.0, dot(w, along));
    return length > margin && gap > (distance + margin) * length ? Quick::no : Quick::unsure;
}

struct Bounds {
    double lower;
    double upper;
};

Bounds in_double(std::span<const Double3> points, const Corners& t) noexcept {
    if (points.size() == 1) {
        const PointTriangleDistance d = point_triangle_distance(points[0], t);
        return {d.lower, d.upper};
    }
    const TriangleDistance d = triangle_distance({points[0], points[1], points.back()}, t, false);
    return {d.lower, d.upper};
}

}  // namespace

bool is_within_in_integers(std::span<const Double3> points, const Corners& t,
                           double distance) noexcept {
    assert(distance >= 0 && std::isfinite(distance));
    const int lowest = std::min({lowest_bit_of(points), lowest_bit_of(t), lowest_bit(distance)});
    const Figure a = figure(points, lowest);
    const Figure b = figure(t, lowest);
    const Length radius = Length::from_double(distance, lowest);
    const Square limit = radius * radius;
    return near_any_corner(a, b, limit) || near_any_corner(b, a, limit) ||
           near_any_edges(a, b, limit);
}

bool is_within_exactly(std::span<const Double3> points, const Corners& t,
                       double distance) noexcept {
    if (!(distance >= 0) || boxes_are_apart(points, t, distance)) return false;
    const Corners filled = {points[0], points[points.size() / 2], points.back()};
    if (distance == 0) return triangles_touch(filled, t);
    const Quick quick = quick_answer(points, t, distance);
    if (quick != Quick::unsure) return quick == Quick::yes;
    if (in_range(points) && in_range(t)) {
        const Bounds bounds = in_double(points, t);
        if (bounds.upper <= distance) return true;
        if (bounds.lower > distance) return false;
    }
    if (triangles_touch(filled, t)) return true;
    if (!(distance <= std::numeric_limits<double>::max())) return true;
    return is_within_in_integers(points, t, distance);
}

}  // namespace cdprep
