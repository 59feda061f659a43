// SPDX-License-Identifier: MIT
#include "exact/exact_common_point.h"

#include <algorithm>

#include "exact/edge_on_plane.h"
#include "exact/predicates.h"
#include "exact/vectors.h"

// If the planes cross, an edge bounds the common segment. Otherwise both lie in one plane, or one
// has no area. Then a corner lies on the other triangle, or an edge crosses the inside of an edge
// or of a face.

namespace cdprep {
namespace {

struct Edge {
    Double3 from;
    Double3 to;
};

Edge edge_of(const Corners& t, std::size_t i) noexcept {
    return {t[i], t[(i + 1) % 3]};
}

bool touches(const Edge& edge, const Corners& t) noexcept {
    return triangles_touch({edge.from, edge.to, edge.to}, t);
}

/// Returns whether the plane has an end of the edge on each side.
bool is_crossed(const Corners& plane, const Edge& edge) noexcept {
    return orient3d(plane[0], plane[1], plane[2], edge.from) *
               orient3d(plane[0], plane[1], plane[2], edge.to) <
           0;
}

/// Returns a corner of `a` that lies on b.
std::optional<Double3> corner_on(const Corners& a, const Corners& b) noexcept {
    for (const Double3& p : a) {
        if (triangles_touch({p, p, p}, b)) return p;
    }
    return std::nullopt;
}

/// Returns the point where an edge of `a` crosses the face of b.
std::optional<Double3> edge_through(const Corners& a, const Corners& b) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge = edge_of(a, i);
        if (is_crossed(b, edge) && touches(edge, b)) return edge_on_plane(edge.from, edge.to, b);
    }
    return std::nullopt;
}

/// Returns the point where two edges cross that touch inside both. The plane for it has one of them
/// and a coordinate axis. `length` is not 0.
std::optional<Double3> crossing_of(const Edge& edge, const Edge& other, double length) noexcept {
    const auto changed = [&](double x) { return x == 0 ? length : 0; };
    const Double3& p = other.from;
    for (const Double3& above : {Double3{changed(p.x), p.y, p.z}, Double3{p.x, changed(p.y), p.z},
                                 Double3{p.x, p.y, changed(p.z)}}) {
        const Corners plane = {p, other.to, above};
        if (is_crossed(plane, edge)) return edge_on_plane(edge.from, edge.to, plane);
    }
    return std::nullopt;
}

/// Returns the point where two edges cross.
std::optional<Double3> edges_crossing(const Corners& a, const Corners& b) noexcept {
    const double length = std::max({largest_of(a[0]), largest_of(a[1]), largest_of(a[2])});
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const Edge edge = edge_of(a, i), other = edge_of(b, j);
            if (!touches(edge, {other.from, other.to, other.to})) continue;
            if (const auto point = crossing_of(edge, other, length)) return point;
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<Double3> exact_common_point(const Corners& a, const Corners& b) noexcept {
    if (!triangles_touch(a, b)) return std::nullopt;
    if (const auto ends = crossing_ends(a, b)) {
        const PiercingEdge& edge = ends->first;
        return edge_on_plane(edge.from, edge.to, edge.of_a ? b : a);
    }
    if (const auto point = corner_on(a, b)) return point;
    if (const auto point = corner_on(b, a)) return point;
    if (const auto point = edge_through(a, b)) return point;
    if (const auto point = edge_through(b, a)) return point;
    return edges_crossing(a, b);
}

}  // namespace cdprep
