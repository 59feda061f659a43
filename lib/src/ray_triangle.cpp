// SPDX-License-Identifier: MIT
#include "ray_triangle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "predicates.h"

namespace cdprep {
namespace {

using Signs = std::array<int, 3>;

std::array<double, 3> axes(const Double3& p) {
    return {p.x, p.y, p.z};
}

/// (p - origin) . (through - origin) / |through - origin|^2, rounded; the largest
/// direction component alone decides for points on the line.
double along(const HalfLine& ray, const Double3& p) {
    const std::array<double, 3> o = axes(ray.origin), d = axes(ray.through), at = axes(p);
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (std::fabs(d[i] - o[i]) > std::fabs(d[axis] - o[axis])) axis = i;
    }
    return (at[axis] - o[axis]) / (d[axis] - o[axis]);
}

/// Whether p, which lies on the line, is not behind the origin. Exact: compares
/// coordinates.
bool is_ahead(const HalfLine& ray, const Double3& p) {
    const std::array<double, 3> o = axes(ray.origin), d = axes(ray.through), at = axes(p);
    for (std::size_t i = 0; i < 3; ++i) {
        if (d[i] != o[i]) return at[i] == o[i] || (at[i] > o[i]) == (d[i] > o[i]);
    }
    return false;
}

/// Keeps the smallest of the values seen.
void take(std::optional<double>& best, double t) {
    t = std::max(t, 0.0);
    if (!best || t < *best) best = t;
}

/// Where the planes' crossing lies: the ratio of two volumes.
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
    const int along_scale = scale(size(ray.through, ray.origin));
    const double to = against_n(difference(t[0], ray.origin, to_scale));
    const double step = against_n(difference(ray.through, ray.origin, along_scale));
    return step == 0 ? 0 : std::ldexp(to / step, along_scale - to_scale);
}

/// A coordinate plane, by the two axes that it keeps.
struct View {
    std::size_t first;
    std::size_t second;
    [[nodiscard]] Double2 operator()(const Double3& p) const {
        const std::array<double, 3> at = axes(p);
        return {at[first], at[second]};
    }
};

constexpr std::array<View, 3> kViews = {{{1, 2}, {2, 0}, {0, 1}}};

/// Where the half-line meets an edge in one plane, seen in a view that keeps it.
void take_edge(const HalfLine& ray, const View& view, const Double3& u, const Double3& v,
               std::optional<double>& best) {
    const int side_u = orient2d(view(ray.origin), view(ray.through), view(u));
    const int side_v = orient2d(view(ray.origin), view(ray.through), view(v));
    if (side_u == 0 && is_ahead(ray, u)) take(best, along(ray, u));
    if (side_v == 0 && is_ahead(ray, v)) take(best, along(ray, v));
    if (side_u * side_v >= 0) return;
    const int side = orient2d(view(u), view(v), view(ray.origin));
    // Ahead when the origin is on the edge, or on the side that the ray comes from.
    if (side == -side_v) return;
    const Double2 o = view(ray.origin), d = view(ray.through), a = view(u), b = view(v);
    const double step = (d.x - o.x) * (b.y - a.y) - (d.y - o.y) * (b.x - a.x);
    const double to = (a.x - o.x) * (b.y - a.y) - (a.y - o.y) * (b.x - a.x);
    take(best, step == 0 ? 0 : to / step);
}

/// The line lies in the triangle's plane, or meets a triangle without area.
std::optional<double> coplanar_ray(const HalfLine& ray, const Corners& t) {
    std::optional<double> best;
    if (triangles_touch({ray.origin, ray.origin, ray.origin}, t)) return 0.0;
    const auto keeps = [&](const View& view) {
        return std::any_of(t.begin(), t.end(), [&](const Double3& p) {
            return orient2d(view(ray.origin), view(ray.through), view(p)) != 0;
        });
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
    const Signs turns = {orient3d(ray.origin, ray.through, t[0], t[1]),
                         orient3d(ray.origin, ray.through, t[1], t[2]),
                         orient3d(ray.origin, ray.through, t[2], t[0])};
    const int least = *std::min_element(turns.begin(), turns.end());
    const int greatest = *std::max_element(turns.begin(), turns.end());
    if (least < 0 && greatest > 0) return std::nullopt;
    if (least == 0 && greatest == 0) return coplanar_ray(ray, t);
    // The three volumes add up to that of the direction over the triangle, so
    // their common sign is that of the direction against the plane.
    const int turn = least + greatest < 0 ? -1 : 1;
    const int side = orient3d(t[0], t[1], t[2], ray.origin);
    if (side == turn) return std::nullopt;
    return side == 0 ? 0.0 : std::max(0.0, crossing_parameter(ray, t));
}

}  // namespace cdprep
