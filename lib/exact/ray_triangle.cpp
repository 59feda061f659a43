// SPDX-License-Identifier: MIT
#include "exact/ray_triangle.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <initializer_list>

#include "exact/expansion.h"
#include "exact/predicates.h"
#include "exact/wide_integer.h"

// The signs that decide are those of orient3d() and orient2d(), with the direction in place of a
// second point of the line. The second point, origin + direction, may not be a double, so the
// determinants contain the direction itself.

namespace cdprep {
namespace {

using Signs = std::array<int, 3>;

std::array<double, 3> axes(const Double3& p) {
    return {p.x, p.y, p.z};
}

/// Returns the place of p on the line in lengths of the step, rounded. Uses only the step's largest
/// component, which is enough for points on the line.
double along(const HalfLine& ray, const Double3& p) {
    const std::array<double, 3> o = axes(ray.origin), d = axes(ray.step), at = axes(p);
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (std::fabs(d[i]) > std::fabs(d[axis])) axis = i;
    }
    assert(d[axis] != 0);
    return (at[axis] - o[axis]) / d[axis];
}

/// Returns whether p, which lies on the line, is not behind the origin. Exact: compares
/// coordinates.
bool is_ahead(const HalfLine& ray, const Double3& p) {
    const std::array<double, 3> o = axes(ray.origin), d = axes(ray.direction), at = axes(p);
    for (std::size_t i = 0; i < 3; ++i) {
        if (d[i] != 0) return at[i] == o[i] || (at[i] > o[i]) == (d[i] > 0);
    }
    return false;
}

/// Keeps the smallest of the values given, at least 0.
void take(std::optional<double>& best, double t) {
    t = std::max(t, 0.0);
    if (!best || t < *best) best = t;
}

/// Returns the place where the line crosses the plane: the ratio of two volumes.
double crossing_parameter(const HalfLine& ray, const Corners& t) {
    const auto difference = [](const Double3& a, const Double3& b, int e) {
        return Double3{std::ldexp(a.x - b.x, e), std::ldexp(a.y - b.y, e),
                       std::ldexp(a.z - b.z, e)};
    };
    const auto size = [&](const Double3& a, const Double3& b) {
        const Double3 v = difference(a, b, 0);
        return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    };
    const auto scale = [](double x) { return x > 0 ? -std::ilogb(x) : 0; };
    const int edge_scale = scale(std::max(size(t[1], t[0]), size(t[2], t[0])));
    const Double3 u = difference(t[1], t[0], edge_scale);
    const Double3 v = difference(t[2], t[0], edge_scale);
    const Double3 n = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const auto against_n = [&](const Double3& w) { return n.x * w.x + n.y * w.y + n.z * w.z; };
    const int to_scale = scale(size(t[0], ray.origin));
    const int along_scale = scale(size(ray.step, {0, 0, 0}));
    const double to = against_n(difference(t[0], ray.origin, to_scale));
    const double step = against_n(difference(ray.step, {0, 0, 0}, along_scale));
    return step == 0 ? 0 : std::ldexp(to / step, along_scale - to_scale);
}

/// A projection to a coordinate plane, given by the two axes that it keeps.
struct View {
    std::size_t first;
    std::size_t second;
    [[nodiscard]] Double2 operator()(const Double3& p) const {
        const std::array<double, 3> at = axes(p);
        return {at[first], at[second]};
    }
};

constexpr std::array<View, 3> kViews = {{{1, 2}, {2, 0}, {0, 1}}};

/// Converts numbers to integer multiples of the lowest bit that occurs.
class Multiples {
public:
    explicit Multiples(std::initializer_list<Double3> points) noexcept {
        for (const Double3& p : points) {
            lowest_ = std::min({lowest_, lowest_bit(p.x), lowest_bit(p.y), lowest_bit(p.z)});
        }
    }
    using Number = WideInteger<kWideCoordinate>;
    [[nodiscard]] Number operator()(double x) const noexcept {
        return Number::from_double(x, lowest_);
    }
    [[nodiscard]] std::array<Number, 3> operator()(const Double3& p) const noexcept {
        return {(*this)(p.x), (*this)(p.y), (*this)(p.z)};
    }
    [[nodiscard]] std::array<Number, 3> operator()(const Double3& p,
                                                   const Double3& from) const noexcept {
        return {(*this)(p.x) - (*this)(from.x), (*this)(p.y) - (*this)(from.y),
                (*this)(p.z) - (*this)(from.z)};
    }

private:
    int lowest_ = lowest_bit(0);
};

/// Returns whether products of three such numbers lose nothing: see predicates.cpp.
bool safe_to_multiply(double component) {
    const double size = std::fabs(component);
    return size == 0 || (size >= 0x1p-250 && size <= 0x1p300);
}

template <std::size_t N>
bool safe_to_multiply(const Expansion<N>& e) {
    return std::all_of(e.component.begin(),
                       e.component.begin() + static_cast<std::ptrdiff_t>(e.size),
                       [](double component) { return safe_to_multiply(component); });
}

/// Returns the sign of det[a - o, b - o, d] by expansions, or 2 where one might lose a bit.
int sign_in_expansions(const Double3& a, const Double3& b, const Double3& o, const Double3& d) {
    const Expansion<2> ax = difference(a.x, o.x), ay = difference(a.y, o.y);
    const Expansion<2> az = difference(a.z, o.z), bx = difference(b.x, o.x);
    const Expansion<2> by = difference(b.y, o.y), bz = difference(b.z, o.z);
    for (const Expansion<2>& e : {ax, ay, az, bx, by, bz}) {
        if (!safe_to_multiply(e)) return 2;
    }
    if (!safe_to_multiply(d.x) || !safe_to_multiply(d.y) || !safe_to_multiply(d.z)) return 2;
    const auto x = sum(product(ay, bz), product(negated(az), by));
    const auto y = sum(product(az, bx), product(negated(ax), bz));
    const auto z = sum(product(ax, by), product(negated(ay), bx));
    return sum(sum(scaled(x, d.x), scaled(y, d.y)), scaled(z, d.z)).sign();
}

int sign_in_integers(const Double3& a, const Double3& b, const Double3& o, const Double3& d) {
    const Multiples of_places{a, b, o};
    const auto p = of_places(a, o);
    const auto q = of_places(b, o);
    const auto n = Multiples{d}(d);
    return (n[0] * (p[1] * q[2] - p[2] * q[1]) + n[1] * (p[2] * q[0] - p[0] * q[2]) +
            n[2] * (p[0] * q[1] - p[1] * q[0]))
        .sign();
}

/// Returns orient3d(origin, origin + direction, a, b), the sign of -det[a - origin, b - origin,
/// direction]. Uses the filter of orient3d(): a rounded step is off by less than the filter's
/// underflow allowance.
int turn_about(const HalfLine& ray, const Double3& a, const Double3& b) {
    const Double3& o = ray.origin;
    const double ax = a.x - o.x, ay = a.y - o.y, az = a.z - o.z;
    const double bx = b.x - o.x, by = b.y - o.y, bz = b.z - o.z;
    const auto& [cx, cy, cz] = ray.step;
    const double determinant =
        ax * (by * cz - bz * cy) + bx * (cy * az - cz * ay) + cx * (ay * bz - az * by);
    const int filtered = filtered_sign(determinant, largest_of(ax, bx, cx), largest_of(ay, by, cy),
                                       largest_of(az, bz, cz));
    if (filtered == 1 || filtered == -1) return -filtered;
    if (a == o || b == o || a == b) return 0;
    const int sign = sign_in_expansions(a, b, o, ray.direction);
    return sign != 2 ? -sign : -sign_in_integers(a, b, o, ray.direction);
}

/// Returns orient2d(origin, origin + direction, p) in a view.
int side_of_line(const HalfLine& ray, const View& view, const Double3& p) {
    const Multiples of_places{ray.origin, p};
    const auto w = of_places(p, ray.origin);
    const auto d = Multiples{ray.direction}(ray.direction);
    return (d[view.first] * w[view.second] - d[view.second] * w[view.first]).sign();
}

/// Returns the place where the line from o along d crosses the line through a and b. This is the
/// ratio of two areas. The factors of each are scaled to lengths near 1, so neither overflows for
/// large coordinates.
double crossing_parameter(const Double2& o, const Double2& d, const Double2& a, const Double2& b) {
    const auto exponent = [](const Double2& v) {
        const double size = std::max(std::fabs(v.x), std::fabs(v.y));
        return size > 0 ? std::ilogb(size) : 0;
    };
    const auto scaled = [](const Double2& v, int e) {
        return Double2{std::ldexp(v.x, -e), std::ldexp(v.y, -e)};
    };
    const Double2 edge = {b.x - a.x, b.y - a.y}, way = {a.x - o.x, a.y - o.y};
    const int of_way = exponent(way), of_step = exponent(d);
    const Double2 e = scaled(edge, exponent(edge)), w = scaled(way, of_way), s = scaled(d, of_step);
    const double step = s.x * e.y - s.y * e.x;
    const double to = w.x * e.y - w.y * e.x;
    return step == 0 ? 0 : std::ldexp(to / step, of_way - of_step);
}

/// Offers the places where the half-line meets an edge in the same plane. The view keeps that
/// plane's area.
void take_edge(const HalfLine& ray, const View& view, const Double3& u, const Double3& v,
               std::optional<double>& best) {
    const int side_u = side_of_line(ray, view, u);
    const int side_v = side_of_line(ray, view, v);
    if (side_u == 0 && is_ahead(ray, u)) take(best, along(ray, u));
    if (side_v == 0 && is_ahead(ray, v)) take(best, along(ray, v));
    if (side_u * side_v >= 0) return;
    const int side = orient2d(view(u), view(v), view(ray.origin));
    // Ahead if the origin is on the edge or on the side that the ray comes from.
    if (side == -side_v) return;
    take(best, crossing_parameter(view(ray.origin), view(ray.step), view(u), view(v)));
}

/// Answers for a line in the triangle's plane, or one that meets a triangle without area.
std::optional<double> coplanar_ray(const HalfLine& ray, const Corners& t) {
    std::optional<double> best;
    if (triangles_touch({ray.origin, ray.origin, ray.origin}, t)) return 0.0;
    const auto keeps = [&](const View& view) {
        return std::any_of(t.begin(), t.end(),
                           [&](const Double3& p) { return side_of_line(ray, view, p) != 0; });
    };
    const auto view = std::find_if(kViews.begin(), kViews.end(), keeps);
    if (view == kViews.end()) {  // all on one line
        for (const Double3& p : t) {
            if (is_ahead(ray, p)) take(best, along(ray, p));
        }
        return best;
    }
    for (std::size_t i = 0; i < 3; ++i) take_edge(ray, *view, t[i], t[(i + 1) % 3], best);
    return best;
}

}  // namespace

std::optional<double> ray_triangle(const HalfLine& ray, const Corners& t) noexcept {
    Signs turns = {turn_about(ray, t[0], t[1]), turn_about(ray, t[1], t[2]), 0};
    if (turns[0] * turns[1] < 0) return std::nullopt;
    turns[2] = turn_about(ray, t[2], t[0]);
    const int least = *std::min_element(turns.begin(), turns.end());
    const int greatest = *std::max_element(turns.begin(), turns.end());
    if (least < 0 && greatest > 0) return std::nullopt;
    if (least == 0 && greatest == 0) return coplanar_ray(ray, t);
    // The three volumes add up to that of the direction over the triangle. So their common sign is
    // the sign of the direction against the plane.
    const int turn = least + greatest < 0 ? -1 : 1;
    const int side = orient3d(t[0], t[1], t[2], ray.origin);
    if (side == turn) return std::nullopt;
    return side == 0 ? 0.0 : std::max(0.0, crossing_parameter(ray, t));
}

}  // namespace cdprep
