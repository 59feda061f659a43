// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/exact_hull.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "cdprep/advanced/disjoint_sets.h"
#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"
#include "hull/quickhull.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::largest_of;

using Facet = std::array<std::uint32_t, 3>;
using Polygon = std::vector<std::uint32_t>;

bool is_before(const Double3& a, const Double3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

bool equal(const Double3& a, const Double3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// The input without repetitions, in lexicographic order. The functions below use "places": the
/// numbers of these distinct points.
struct DistinctPoints {
    std::vector<Double3> at;
    std::vector<std::uint32_t> number;  ///< the least in the input

    [[nodiscard]] bool collinear(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return exact::is_degenerate({at[a], at[b], at[c]});
    }
    [[nodiscard]] int side(const Facet& facet, std::uint32_t p) const {
        return exact::orient3d(at[facet[0]], at[facet[1]], at[facet[2]], at[p]);
    }
};

DistinctPoints distinct_points(std::span<const Double3> points) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (!equal(points[a], points[b])) return is_before(points[a], points[b]);
        return a < b;
    });
    DistinctPoints distinct;
    for (const std::uint32_t number : order) {
        if (!distinct.at.empty() && equal(distinct.at.back(), points[number])) continue;
        distinct.at.push_back(points[number]);
        distinct.number.push_back(number);
    }
    return distinct;
}

/// Points that span the whole set: dimension + 1 of them.
struct Span {
    int dimension = -1;
    std::array<std::uint32_t, 4> places = {};  ///< dimension + 1 of them, for 2 and 3

    [[nodiscard]] Facet plane() const {
        return {places[0], places[1], places[2]};
    }
};

Span find_span(const DistinctPoints& points) {
    const auto count = static_cast<std::uint32_t>(points.at.size());
    if (count < 3) return {.dimension = static_cast<int>(count) - 1};
    const std::uint32_t last = count - 1;
    Span span = {.dimension = 1};
    for (std::uint32_t p = 1; p < last; ++p) {
        if (span.dimension == 1 && !points.collinear(0, last, p)) span = {2, {0, last, p, 0}};
        if (span.dimension == 2 && points.side(span.plane(), p) != 0) {
            span.places[3] = p;
            return {3, span.places};
        }
    }
    return span;
}

Double3 normal_of(const Double3& a, const Double3& b, const Double3& c) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    return {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
}

/// Returns four points that are far apart, by a quick search. A hull that starts with a large
/// tetrahedron has fewer points outside it.
std::array<std::uint32_t, 4> wide_tetrahedron(const DistinctPoints& points, const Span& span) {
    std::array<std::uint32_t, 4> wide = span.places;
    const Double3 a = points.at[wide[0]], b = points.at[wide[1]];
    double most = 0;
    for (std::uint32_t p = 0; p < points.at.size(); ++p) {
        const double size = largest_of(normal_of(a, b, points.at[p]));
        if (size > most) most = size, wide[2] = p;
    }
    const Double3 normal = normal_of(a, b, points.at[wide[2]]);
    most = 0;
    for (std::uint32_t p = 0; p < points.at.size(); ++p) {
        const Double3& q = points.at[p];
        const double height =
            std::fabs(normal.x * (q.x - a.x) + normal.y * (q.y - a.y) + normal.z * (q.z - a.z));
        if (height > most) most = height, wide[3] = p;
    }
    return points.side({wide[0], wide[1], wide[2]}, wide[3]) != 0 ? wide : span.places;
}

/// A projection of a plane's points along an axis that preserves their turns.
struct Projection {
    int axis;

    [[nodiscard]] Double2 operator()(const Double3& p) const {
        if (axis == 0) return {p.y, p.z};
        return axis == 1 ? Double2{p.z, p.x} : Double2{p.x, p.y};
    }
};

Projection projection_of(const DistinctPoints& points, const Facet& plane) {
    for (int axis = 0; axis < 2; ++axis) {
        const Projection flat = {axis};
        if (exact::orient2d(flat(points.at[plane[0]]), flat(points.at[plane[1]]),
                            flat(points.at[plane[2]])) != 0) {
            return flat;
        }
    }
    return {2};
}

/// Adds a point to a chain that turns left everywhere.
void add_to_chain(Polygon& chain, std::size_t first, std::uint32_t p, const DistinctPoints& points,
                  Projection flat) {
    while (chain.size() >= first + 2 &&
           exact::orient2d(flat(points.at[chain[chain.size() - 2]]), flat(points.at[chain.back()]),
                           flat(points.at[p])) <= 0) {
        chain.pop_back();
    }
    chain.push_back(p);
}

/// Returns the hull of coplanar points by monotone chains, corners only.
Polygon polygon_of(const DistinctPoints& points, const Facet& plane) {
    const Projection flat = projection_of(points, plane);
    std::vector<std::uint32_t> order(points.at.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const Double2 p = flat(points.at[a]), q = flat(points.at[b]);
        return std::tie(p.x, p.y) < std::tie(q.x, q.y);
    });
    Polygon polygon;
    for (const std::uint32_t p : order) add_to_chain(polygon, 0, p, points, flat);
    const std::size_t turn = polygon.size() - 1;
    for (auto p = order.rbegin() + 1; p != order.rend(); ++p) {
        add_to_chain(polygon, turn, *p, points, flat);
    }
    polygon.pop_back();
    return polygon;
}

/// Returns a polygon whose fan is around its least place.
Polygon least_first(Polygon polygon) {
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
    return polygon;
}

/// Returns both sides of a polygon. The fan of the back is around another point, so that no
/// facets of the two sides share a diagonal.
std::vector<Polygon> both_sides(const Polygon& polygon) {
    return {polygon, {polygon.rbegin(), polygon.rend()}};
}

/// The facets of a surface: sets of coplanar triangles.
class Coplanar {
public:
    Coplanar(std::span<const HullFace> faces, const DistinctPoints& points)
        : faces_(faces), points_(&points), sets_(faces.size()) {
        for (std::uint32_t f = 0; f < faces.size(); ++f) {
            for (std::uint32_t edge = 0; edge < 3; ++edge) {
                const Half half = {f, edge}, twin = opposite(half);
                if (twin.face < f) continue;
                const std::uint32_t beyond = faces[twin.face].corner[(twin.edge + 2) % 3];
                if (points.side(faces[f].corner, beyond) == 0) sets_.unite(f, twin.face);
            }
        }
    }

    /// Returns the corners of each set. A vertex that is not a corner of its face lies inside
    /// the face or one of its edges. It is then no corner of any face.
    [[nodiscard]] std::vector<Polygon> polygons() {
        std::vector<Polygon> all;
        std::vector<std::array<bool, 3>> seen(faces_.size());
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            for (std::uint32_t edge = 0; edge < 3; ++edge) {
                if (seen[f][edge] || !is_border({f, edge})) continue;
                all.push_back(least_first(corners(loop({f, edge}, seen))));
            }
        }
        return all;
    }

private:
    /// The edge of a face from its corner `edge` to the next.
    struct Half {
        std::uint32_t face, edge;
    };

    [[nodiscard]] std::uint32_t source(Half half) const {
        return faces_[half.face].corner[half.edge];
    }
    [[nodiscard]] static Half next(Half half) {
        return {half.face, (half.edge + 1) % 3};
    }
    [[nodiscard]] Half opposite(Half half) const {
        const std::uint32_t face = faces_[half.face].across[half.edge];
        const std::uint32_t from = source(next(half));
        Half twin = {face, 0};
        while (source(twin) != from) ++twin.edge;
        return twin;
    }
    [[nodiscard]] bool is_border(Half half) {
        return sets_.root_of(half.face) != sets_.root_of(faces_[half.face].across[half.edge]);
    }

    /// Returns the loop around the set left of `first`. The set is convex, so there is one loop.
    [[nodiscard]] Polygon loop(Half first, std::vector<std::array<bool, 3>>& seen) {
        Polygon around;
        Half half = first;
        do {
            seen[half.face][half.edge] = true;
            around.push_back(source(half));
            half = next(half);
            while (!is_border(half)) half = next(opposite(half));
        } while (half.face != first.face || half.edge != first.edge);
        return around;
    }

    [[nodiscard]] Polygon corners(const Polygon& around) const {
        Polygon kept;
        for (std::size_t i = 0; i < around.size(); ++i) {
            const std::uint32_t before = around[(i + around.size() - 1) % around.size()];
            const std::uint32_t after = around[(i + 1) % around.size()];
            if (!points_->collinear(before, around[i], after)) kept.push_back(around[i]);
        }
        return kept;
    }

    std::span<const HullFace> faces_;
    const DistinctPoints* points_;
    build::DisjointSets sets_;
};

std::vector<Polygon> polygons_of(const DistinctPoints& points, const Span& span) {
    if (span.dimension == 2) return both_sides(least_first(polygon_of(points, span.plane())));
    const std::vector<HullFace> faces = quickhull(points.at, wide_tetrahedron(points, span));
    return Coplanar(faces, points).polygons();
}

/// Returns the places of extreme points, in order of their input numbers.
std::vector<std::uint32_t> extreme_places(const DistinctPoints& points,
                                          const std::vector<Polygon>& polygons) {
    std::vector<std::uint32_t> places;
    for (const Polygon& polygon : polygons) {
        places.insert(places.end(), polygon.begin(), polygon.end());
    }
    std::sort(places.begin(), places.end(), [&](std::uint32_t a, std::uint32_t b) {
        return points.number[a] < points.number[b];
    });
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
}

void add_points(ConvexHull& hull, const DistinctPoints& points,
                std::span<const std::uint32_t> places) {
    for (const std::uint32_t place : places) {
        hull.points.push_back(points.at[place]);
        hull.numbers.push_back(points.number[place]);
    }
}

/// Returns the fan around the first place. Each triangle is rotated to start with its least
/// name.
std::vector<Facet> fan_of(const Polygon& polygon, std::span<const std::uint32_t> name_of) {
    std::vector<Facet> fan;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        Facet facet = {name_of[polygon[0]], name_of[polygon[i - 1]], name_of[polygon[i]]};
        std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
        fan.push_back(facet);
    }
    std::sort(fan.begin(), fan.end());
    return fan;
}

void add_facets(ConvexHull& hull, const std::vector<Polygon>& polygons,
                std::span<const std::uint32_t> name_of) {
    std::vector<std::vector<Facet>> fans;
    fans.reserve(polygons.size());
    for (const Polygon& polygon : polygons) fans.push_back(fan_of(polygon, name_of));
    std::sort(fans.begin(), fans.end());
    hull.groups.clear();
    for (const std::vector<Facet>& fan : fans) {
        hull.groups.push_back(static_cast<std::uint32_t>(hull.facets.size()));
        hull.facets.insert(hull.facets.end(), fan.begin(), fan.end());
    }
    hull.groups.push_back(static_cast<std::uint32_t>(hull.facets.size()));
}

/// Returns the ends of a segment, or the only point: they are first and last in the order.
std::vector<std::uint32_t> ends_of(const DistinctPoints& points) {
    if (points.at.empty()) return {};
    const auto last = static_cast<std::uint32_t>(points.at.size()) - 1;
    std::vector<std::uint32_t> ends = {0};
    if (last != 0) ends.push_back(last);
    std::sort(ends.begin(), ends.end(), [&](std::uint32_t a, std::uint32_t b) {
        return points.number[a] < points.number[b];
    });
    return ends;
}

}  // namespace

ConvexHull exact_hull(std::span<const Double3> input) {
    const DistinctPoints points = distinct_points(input);
    const Span span = find_span(points);
    ConvexHull hull;
    hull.dimension = span.dimension;
    if (span.dimension < 2) {
        add_points(hull, points, ends_of(points));
        return hull;
    }
    const std::vector<Polygon> polygons = polygons_of(points, span);
    const std::vector<std::uint32_t> places = extreme_places(points, polygons);
    add_points(hull, points, places);
    std::vector<std::uint32_t> name_of(points.at.size());
    for (std::uint32_t name = 0; name < places.size(); ++name) name_of[places[name]] = name;
    add_facets(hull, polygons, name_of);
    return hull;
}

}  // namespace cdprep::convex
