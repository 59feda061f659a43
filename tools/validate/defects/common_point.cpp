// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/common_point.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/vectors.h"

namespace cdprep::mesh {
namespace {

Double3 between(const Double3& a, const Double3& b, double share) {
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

/// Returns where a segment meets the plane through `on`, from the heights of its ends above it.
Double3 meets_plane(const Double3& from, const Double3& to, const Double3& on,
                    const Double3& normal) {
    const double above_from = dot(minus(from, on), normal);
    const double above_to = dot(minus(to, on), normal);
    const double share = above_from / (above_from - above_to);
    return between(from, to, std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.5);
}

Double3 end_of(const PiercingEdge& edge, const Corners& a, const Corners& b) {
    const Corners& plane = edge.of_a ? b : a;
    return meets_plane(edge.from, edge.to, plane[0],
                       cross(minus(plane[1], plane[0]), minus(plane[2], plane[0])));
}

/// Returns the mean of the corners of `a` clipped by the sides of `b` (Sutherland and Hodgman
/// 1974).
Double3 middle_of_overlap(const Corners& a, const Corners& b) {
    std::vector<Double3> polygon(a.begin(), a.end());
    const Double3 normal = cross(minus(b[1], b[0]), minus(b[2], b[0]));
    for (std::size_t side = 0; side < b.size(); ++side) {
        const Double3 inwards = cross(normal, minus(b[(side + 1) % 3], b[side]));
        const auto above = [&](const Double3& p) { return dot(minus(p, b[side]), inwards); };
        std::vector<Double3> cut;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Double3& p = polygon[i];
            const Double3& q = polygon[(i + 1) % polygon.size()];
            if (above(p) >= 0) cut.push_back(p);
            if ((above(p) > 0 && above(q) < 0) || (above(p) < 0 && above(q) > 0)) {
                cut.push_back(meets_plane(p, q, b[side], inwards));
            }
        }
        polygon = std::move(cut);
    }
    Double3 sum{};
    for (const Double3& p : polygon) sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
    const auto count = static_cast<double>(polygon.size());
    return {sum.x / count, sum.y / count, sum.z / count};
}

/// Returns x clamped to both ranges; the middle between the ranges if they are disjoint.
double in_both(double x, double a0, double a1, double a2, double b0, double b1, double b2) {
    const double lower = std::max(std::min({a0, a1, a2}), std::min({b0, b1, b2}));
    const double upper = std::min(std::max({a0, a1, a2}), std::max({b0, b1, b2}));
    if (!std::isfinite(x) || lower > upper) return lower / 2 + upper / 2;
    return std::clamp(x, lower, upper);
}

}  // namespace

Double3 common_point(const Corners& a, const Corners& b) {
    Double3 point{};
    if (const auto ends = exact::crossing_ends(a, b)) {
        point = between(end_of(ends->first, a, b), end_of(ends->second, a, b), 0.5);
    } else {
        point = middle_of_overlap(a, b);
    }
    return {in_both(point.x, a[0].x, a[1].x, a[2].x, b[0].x, b[1].x, b[2].x),
            in_both(point.y, a[0].y, a[1].y, a[2].y, b[0].y, b[1].y, b[2].y),
            in_both(point.z, a[0].z, a[1].z, a[2].z, b[0].z, b[1].z, b[2].z)};
}

}  // namespace cdprep::mesh
