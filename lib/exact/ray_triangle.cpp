// SPDX-License-Identifier: MIT
#include "exact/ray_triangle.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <initializer_list>

#include "exact/double_double.h"
#include "exact/expansion.h"
#include "exact/leading_bits.h"
#include "exact/powers_of_two.h"
#include "exact/predicates.h"
#include "exact/wide_integer.h"
#include "exact/wide_vector.h"

// The signs that decide are those of orient3d() and orient2d(), with the direction in place of a
// second point of the line. The second point, origin + direction, may not be a double, so the
// determinants contain the direction itself.
//
// The place of a hit is the quotient of two determinants, of which neither is 0. In double, their
// factors are scaled to lengths near 1. Let u = 2^-53, and let S be the sum of the magnitudes of a
// determinant's products. A difference of coordinates is off by u of itself. A component of the
// triangle's normal is then off by 4 u of its two products, and each product with it by 6 u. The
// sum is off by 8 u S. A planar determinant is off by less. Underflow loses at most 2^-1068, which
// is negligible where S is above 1e-290. So a determinant above 2^-8 S is off by 2^-42 of itself.
// If both are, their quotient is off by less than 2^-40.
//
// Otherwise the ray grazes the triangle, starts near its plane, or meets a sliver. Volumes in twice
// the precision start from exact differences and are off by less than 2^-98 S. So they are off by
// 2^-48 of themselves where they are above 2^-50 S. Integers give both determinants exactly where
// that fails too.

namespace cdprep {
namespace {

using Signs = std::array<int, 3>;

std::array<double, 3> axes(const Double3& p) {
    return {p.x, p.y, p.z};
}

using Length = WideInteger<kWideCoordinate>;

/// Returns the place of p on the line in lengths of the step, rounded. Uses only the direction's
/// largest component, which is enough for points on the line.
double along(const HalfLine& ray, const Double3& p) {
    const std::array<double, 3> o = axes(ray.origin), d = axes(ray.direction), at = axes(p);
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (std::fabs(d[i]) > std::fabs(d[axis])) axis = i;
    }
    assert(d[axis] != 0);
    const double way = at[axis] - o[axis];
    if (ray.exponent == 0 && std::isfinite(way)) return way / d[axis];
    const Length exact = Length::from_double(at[axis]) - Length::from_double(o[axis]);
    return quotient(leading_bits(exact), leading_bits(Length::from_double(d[axis])), -ray.exponent);
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

/// A determinant, rounded, and the sum of the magnitudes of its products.
struct Determinant {
    double value;
    double size;
};

/// Returns whether the determinant is above `part` of its products, which are in range.
bool is_certain(const Determinant& d, double part) {
    constexpr double kLeast = 1e-290;
    constexpr double kMost = 0x1p10;  // exceeded only after an overflow
    return std::fabs(d.value) > part * d.size && d.size > kLeast && d.size < kMost;
}

/// Returns whether double gives the quotient of the two: see the top of the file.
bool are_certain(const HalfLine& ray, const Determinant& to, const Determinant& step) {
    constexpr double kCertain = 0x1p-8;
    return ray.exponent == 0 && is_certain(to, kCertain) && is_certain(step, kCertain);
}

/// The powers of two that bring the edges, the way to the plane and the step to lengths near 1.
struct Exponents {
    int edges;
    int way;
    int step;
};

/// Returns the place where the line crosses the plane by twice the precision of double, if that
/// gives it. The sizes are those of the volumes.
std::optional<double> precise_crossing(const HalfLine& ray, const Corners& t, const Exponents& by,
                                       double size_of_to, double size_of_step) {
    using Vector = std::array<DoubleDouble, 3>;
    constexpr double kCertain = 0x1p-50;
    const auto difference = [](const Double3& a, const Double3& b, int exponent) {
        const Scale scale(exponent);
        const auto part = [&](double x, double from) {
            const Exact2 exact = two_sum(x, -from);
            return DoubleDouble(scale(exact.value), scale(exact.tail));
        };
        return Vector{part(a.x, b.x), part(a.y, b.y), part(a.z, b.z)};
    };
    const Vector u = difference(t[1], t[0], by.edges), v = difference(t[2], t[0], by.edges);
    const Vector n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]};
    const auto against_n = [&](const Vector& w) { return n[0] * w[0] + n[1] * w[1] + n[2] * w[2]; };
    const DoubleDouble to = against_n(difference(t[0], ray.origin, by.way));
    const DoubleDouble step = against_n(difference(ray.step, {0, 0, 0}, by.step));
    const bool certain = ray.exponent == 0 && is_certain({to.high, size_of_to}, kCertain) &&
                         is_certain({step.high, size_of_step}, kCertain);
    if (!certain) return std::nullopt;
    return std::ldexp(static_cast<double>(to / step), by.step - by.way);
}

/// Returns the place where the line crosses the plane: the exact ratio of two volumes, rounded.
double exact_crossing(const HalfLine& ray, const Corners& t) {
    const int lowest = std::min(lowest_bit_of(t), lowest_bit_of({&ray.origin, 1}));
    const int of_direction = lowest_bit_of({&ray.direction, 1});
    const WidePlace a = wide_place(t[0], lowest);
    const auto normal = cross(wide_place(t[1], lowest) - a, wide_place(t[2], lowest) - a);
    return quotient(leading_bits(dot(normal, a - wide_place(ray.origin, lowest))),
                    leading_bits(dot(normal, wide_place(ray.direction, of_direction))),
                    lowest - of_direction - ray.exponent);
}

/// Returns the place where the line crosses the plane: the ratio of two volumes.
double crossing_parameter(const HalfLine& ray, const Corners& t) {
    const auto difference = [](const Double3& a, const Double3& b, int exponent) {
        const Scale scaled(exponent);
        return Double3{scaled(a.x - b.x), scaled(a.y - b.y), scaled(a.z - b.z)};
    };
    const auto size = [](const Double3& a, const Double3& b) {
        return std::max({std::fabs(a.x - b.x), std::fabs(a.y - b.y), std::fabs(a.z - b.z)});
    };
    const auto scale = [](double x) { return x > 0 ? -std::ilogb(x) : 0; };
    const Exponents by = {scale(std::max(size(t[1], t[0]), size(t[2], t[0]))),
                          scale(size(t[0], ray.origin)), scale(size(ray.step, {0, 0, 0}))};
    const Double3 u = difference(t[1], t[0], by.edges);
    const Double3 v = difference(t[2], t[0], by.edges);
    const Double3 n = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const Double3 size_of_n = {std::fabs(u.y * v.z) + std::fabs(u.z * v.y),
                               std::fabs(u.z * v.x) + std::fabs(u.x * v.z),
                               std::fabs(u.x * v.y) + std::fabs(u.y * v.x)};
    const auto against_n = [&](const Double3& w) {
        return Determinant{n.x * w.x + n.y * w.y + n.z * w.z, size_of_n.x * std::fabs(w.x) +
                                                                  size_of_n.y * std::fabs(w.y) +
                                                                  size_of_n.z * std::fabs(w.z)};
    };
    const Determinant to = against_n(difference(t[0], ray.origin, by.way));
    const Determinant step = against_n(difference(ray.step, {0, 0, 0}, by.step));
    if (are_certain(ray, to, step)) return std::ldexp(to.value / step.value, by.step - by.way);
    const std::optional<double> precise = precise_crossing(ray, t, by, to.size, step.size);
    return precise ? *precise : exact_crossing(ray, t);
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

/// Returns the place where the line crosses the line through a and b in a view: the exact ratio of
/// two areas, rounded.
double exact_crossing(const HalfLine& ray, const View& view, const Double3& a, const Double3& b) {
    const std::array<Double3, 3> places = {a, b, ray.origin};
    const int lowest = lowest_bit_of(places);
    const int of_direction = lowest_bit_of({&ray.direction, 1});
    const WidePlace from = wide_place(a, lowest);
    const WidePlace edge = wide_place(b, lowest) - from;
    const auto against_edge = [&](const WidePlace& w) {
        return leading_bits(w[view.first] * edge[view.second] - w[view.second] * edge[view.first]);
    };
    return quotient(against_edge(from - wide_place(ray.origin, lowest)),
                    against_edge(wide_place(ray.direction, of_direction)),
                    lowest - of_direction - ray.exponent);
}

/// Returns the place where the line crosses the line through two points in a view: the ratio of two
/// areas.
double crossing_parameter(const HalfLine& ray, const View& view, const Double3& from,
                          const Double3& to) {
    const auto exponent = [](const Double2& v) {
        const double size = std::max(std::fabs(v.x), std::fabs(v.y));
        return size > 0 ? std::ilogb(size) : 0;
    };
    const auto scaled = [](const Double2& v, int e) {
        return Double2{std::ldexp(v.x, -e), std::ldexp(v.y, -e)};
    };
    const Double2 o = view(ray.origin), d = view(ray.step), a = view(from), b = view(to);
    const Double2 edge = {b.x - a.x, b.y - a.y}, way = {a.x - o.x, a.y - o.y};
    const int of_way = exponent(way), of_step = exponent(d);
    const Double2 e = scaled(edge, exponent(edge)), w = scaled(way, of_way), s = scaled(d, of_step);
    const auto against_edge = [&](const Double2& p) {
        return Determinant{p.x * e.y - p.y * e.x, std::fabs(p.x * e.y) + std::fabs(p.y * e.x)};
    };
    const Determinant to_edge = against_edge(w), step = against_edge(s);
    if (!are_certain(ray, to_edge, step)) return exact_crossing(ray, view, from, to);
    return std::ldexp(to_edge.value / step.value, of_way - of_step);
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
    take(best, crossing_parameter(ray, view, u, v));
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
