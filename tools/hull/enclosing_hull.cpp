// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/enclosing_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"
#include "hull/exact_hull.h"
#include "mesh/vectors.h"

// K half-spaces that touch the hull contain it, and their intersection has at most 2 K - 4
// corners. The method is greedy. It cuts off the corner farthest from the hull. The plane passes
// through the nearest point of the hull, at right angles to the way there. It starts with a box
// and with a tetrahedron, and keeps the result with the smaller distance.
//
// The corners of an intersection are the faces of the convex hull of the planes' poles. The pole
// of the plane n x = h, seen from a point inside, is n / h. All this uses rounded numbers. The
// result is checked exactly, and the planes move outwards step by step until it passes.
namespace cdprep::convex {
namespace {

using mesh::cross;
using mesh::dot;
using mesh::largest_of;
using mesh::minus;
using mesh::plus;
using mesh::scaled;

/// The first distance of planes from the hull, in units of half the largest side. It is the
/// rounding error of the corners of well-shaped intersections.
constexpr double kFirstSlack = 0x1p-48;
constexpr double kSlackGrowth = 8;
constexpr int kSlackSteps = 20;  ///< the last slack is 2^9: far beyond the hull
constexpr std::uint32_t kBoxCorners = 8;
/// Corners closer to the hull than this do not justify a plane; in the same units.
constexpr double kClose = 0x1p-40;
/// The error of a height above a facet's plane is less than this times its edges' lengths.
constexpr double kHeightError = 0x1p-45;

using Facet = std::array<std::uint32_t, 3>;

/// The map to coordinates of size 1 around a point inside, the mean of the corners.
struct Frame {
    Double3 origin;
    int exponent;

    [[nodiscard]] Double3 inwards(const Double3& p) const {
        const Double3 d = minus(p, origin);
        return {std::ldexp(d.x, -exponent), std::ldexp(d.y, -exponent), std::ldexp(d.z, -exponent)};
    }
    [[nodiscard]] Double3 outwards(const Double3& y) const {
        return plus(
            {std::ldexp(y.x, exponent), std::ldexp(y.y, exponent), std::ldexp(y.z, exponent)},
            origin);
    }
};

Frame frame_of(std::span<const Double3> points) {
    Double3 mean = {};
    for (const Double3& p : points) {
        mean = plus(mean, scaled(p, 1 / static_cast<double>(points.size())));
    }
    double size = 0;
    for (const Double3& p : points) size = std::max(size, largest_of(minus(p, mean)));
    return {mean, std::ilogb(size) + 1};
}

/// The half-space n y <= height; n has length 1 up to rounding.
struct HalfSpace {
    Double3 normal;
    double height;
};

/// A corner of the intersection, and the facet of poles that identifies it.
struct Corner {
    Facet planes;
    Double3 at;
};

/// Returns the common point of three planes; not finite if there is none.
Double3 meeting_point(const HalfSpace& a, const HalfSpace& b, const HalfSpace& c) {
    const Double3 bc = cross(b.normal, c.normal), ca = cross(c.normal, a.normal),
                  ab = cross(a.normal, b.normal);
    return scaled(plus(plus(scaled(bc, a.height), scaled(ca, b.height)), scaled(ab, c.height)),
                  1 / dot(a.normal, bc));
}

double volume_of(std::span<const HalfSpace> planes, const Facet& facet) {
    return std::fabs(
        dot(planes[facet[0]].normal, cross(planes[facet[1]].normal, planes[facet[2]].normal)));
}

/// Returns the corners of the intersection, with all planes moved outwards by `slack`.
std::vector<Corner> corners_of(std::vector<HalfSpace> planes, double slack) {
    std::vector<Double3> poles;
    for (HalfSpace& plane : planes) {
        plane.height += slack;
        poles.push_back(scaled(plane.normal, 1 / plane.height));
    }
    const ConvexHull dual = exact_hull(poles);
    std::vector<Corner> corners;
    if (dual.dimension < 3) return corners;
    for (std::size_t g = 0; g + 1 < dual.groups.size(); ++g) {
        Facet best = {};
        double most = -1;
        for (std::uint32_t f = dual.groups[g]; f < dual.groups[g + 1]; ++f) {
            const auto& [a, b, c] = dual.facets[f];
            const Facet facet = {dual.numbers[a], dual.numbers[b], dual.numbers[c]};
            const double volume = volume_of(planes, facet);
            if (volume > most) most = volume, best = facet;
        }
        corners.push_back({best, meeting_point(planes[best[0]], planes[best[1]], planes[best[2]])});
    }
    return corners;
}

/// The exact hull in its frame.
class Inner {
public:
    explicit Inner(const ConvexHull& exact) : frame_(frame_of(exact.points)), exact_(&exact) {
        for (const Double3& p : exact.points) points_.push_back(frame_.inwards(p));
        for (std::size_t g = 0; g + 1 < exact.groups.size(); ++g) {
            const Facet& facet = exact.facets[exact.groups[g]];
            const Double3& a = points_[facet[0]];
            const Double3 u = minus(points_[facet[1]], a);
            const Double3 v = minus(points_[facet[2]], a);
            normals_.push_back(cross(u, v));
            heights_.push_back(dot(normals_.back(), a));
            doubts_.push_back(kHeightError * largest_of(u) * largest_of(v));
        }
    }

    [[nodiscard]] const Frame& frame() const {
        return frame_;
    }
    [[nodiscard]] HalfSpace touching(const Double3& normal) const {
        double height = 0;
        for (const Double3& p : points_) height = std::max(height, dot(normal, p));
        return {normal, height};
    }

    /// Returns the nearest point of the triangles visible from `p`. If none is visible, uses the
    /// triangles that `p` is least far behind. The upper bound is proved for the distance of `p` to
    /// the hull, since any triangle gives such a bound.
    [[nodiscard]] PointTriangleDistance nearest(const Double3& p, const Double3& inside,
                                                std::span<const Double3> corners) const {
        double highest = -std::numeric_limits<double>::infinity();
        for (std::size_t g = 0; g < normals_.size(); ++g) {
            highest = std::max(highest, dot(normals_[g], inside) - heights_[g]);
        }
        PointTriangleDistance best = {};
        best.upper = std::numeric_limits<double>::infinity();
        for (std::size_t g = 0; g < normals_.size(); ++g) {
            const double height = dot(normals_[g], inside) - heights_[g];
            if (height < std::min(highest, 0.0) - doubts_[g]) continue;
            for (std::uint32_t f = exact_->groups[g]; f < exact_->groups[g + 1]; ++f) {
                const Facet& facet = exact_->facets[f];
                const PointTriangleDistance found = exact::point_triangle_distance(
                    p, {corners[facet[0]], corners[facet[1]], corners[facet[2]]});
                if (found.upper < best.upper) best = found;
            }
        }
        return best;
    }
    /// Takes and returns coordinates of the frame.
    [[nodiscard]] PointTriangleDistance nearest(const Double3& y) const {
        return nearest(y, y, points_);
    }
    /// Takes and returns model coordinates.
    [[nodiscard]] PointTriangleDistance nearest_of_model(const Double3& p) const {
        return nearest(p, frame_.inwards(p), exact_->points);
    }

private:
    Frame frame_;
    const ConvexHull* exact_;
    std::vector<Double3> points_, normals_;
    std::vector<double> heights_, doubts_;
};

using Normals = std::span<const Double3>;

const std::array<Double3, 6> kBox = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
const double kDiagonal = std::sqrt(1.0 / 3);
const std::array<Double3, 4> kTetrahedron = {{{kDiagonal, kDiagonal, kDiagonal},
                                              {kDiagonal, -kDiagonal, -kDiagonal},
                                              {-kDiagonal, kDiagonal, -kDiagonal},
                                              {-kDiagonal, -kDiagonal, kDiagonal}}};

/// Finds the plane that cuts off the worst corner; none if all corners are close.
class Cutter {
public:
    explicit Cutter(const Inner& inner) : inner_(&inner) {}

    [[nodiscard]] std::optional<HalfSpace> next_plane(const std::vector<Corner>& corners) {
        double worst = kClose;
        std::optional<HalfSpace> plane;
        for (const Corner& corner : corners) {
            const PointTriangleDistance& nearest = nearest_to(corner);
            const Double3 way = minus(corner.at, nearest.nearest);
            const double length = std::sqrt(dot(way, way));
            if (!(length > worst)) continue;
            worst = length;
            plane = HalfSpace{scaled(way, 1 / length), 0};
        }
        if (plane) plane = inner_->touching(plane->normal);
        return plane;
    }

private:
    /// Caches the results: most corners existed in the step before.
    const PointTriangleDistance& nearest_to(const Corner& corner) {
        const auto known = known_.find(corner.planes);
        if (known != known_.end()) return known->second;
        return known_.emplace(corner.planes, inner_->nearest(corner.at)).first->second;
    }

    const Inner* inner_;
    std::map<Facet, PointTriangleDistance> known_;
};

std::vector<HalfSpace> chosen_planes(const Inner& inner, Normals first,
                                     std::uint32_t max_vertices) {
    std::vector<HalfSpace> planes;
    for (const Double3& normal : first) planes.push_back(inner.touching(normal));
    Cutter cutter(inner);
    std::vector<Corner> corners = corners_of(planes, kFirstSlack);
    // Planes that cut nothing off because of rounding must not continue forever.
    while (planes.size() < max_vertices + kTetrahedron.size()) {
        const std::optional<HalfSpace> plane = cutter.next_plane(corners);
        if (!plane) break;
        planes.push_back(*plane);
        corners = corners_of(planes, kFirstSlack);
        if (corners.size() <= max_vertices) continue;
        planes.pop_back();
        break;
    }
    return planes;
}

bool contains(const ConvexHull& outer, std::span<const Double3> points) {
    if (outer.dimension < 3) return false;
    for (std::size_t g = 0; g + 1 < outer.groups.size(); ++g) {
        const Facet& facet = outer.facets[outer.groups[g]];
        for (const Double3& p : points) {
            if (exact::orient3d(outer.points[facet[0]], outer.points[facet[1]],
                                outer.points[facet[2]], p) < 0) {
                return false;
            }
        }
    }
    return true;
}

/// Returns the hull of the corners as stored; nothing if one is not finite.
std::optional<ConvexHull> stored_hull(const std::vector<Corner>& corners, const Frame& frame) {
    std::vector<Double3> points;
    for (const Corner& corner : corners) {
        points.push_back(frame.outwards(corner.at));
        if (!mesh::is_finite(points.back())) return std::nullopt;
    }
    ConvexHull hull = exact_hull(points);
    hull.numbers.clear();
    return hull;
}

double distance_of(const ConvexHull& outer, const Inner& inner) {
    double distance = 0;
    for (const Double3& p : outer.points) {
        distance = std::max(distance, inner.nearest_of_model(p).upper);
    }
    return distance;
}

std::optional<EnclosingHull> enclosing_from(const Inner& inner, const ConvexHull& exact,
                                            Normals first, std::uint32_t max_vertices) {
    const std::vector<HalfSpace> planes = chosen_planes(inner, first, max_vertices);
    double slack = kFirstSlack;
    for (int step = 0; step < kSlackSteps; ++step, slack *= kSlackGrowth) {
        const std::vector<Corner> corners = corners_of(planes, slack);
        if (corners.size() > max_vertices) continue;
        std::optional<ConvexHull> hull = stored_hull(corners, inner.frame());
        if (!hull || !contains(*hull, exact.points)) continue;
        const double distance = distance_of(*hull, inner);
        return EnclosingHull{*std::move(hull), distance};
    }
    return std::nullopt;
}

}  // namespace

std::optional<EnclosingHull> enclosing_hull(const ConvexHull& exact, std::uint32_t max_vertices) {
    if (exact.points.size() <= max_vertices) return EnclosingHull{exact, 0};
    const Inner inner(exact);
    std::optional<EnclosingHull> best = enclosing_from(inner, exact, kTetrahedron, max_vertices);
    if (max_vertices < kBoxCorners) return best;
    std::optional<EnclosingHull> boxed = enclosing_from(inner, exact, kBox, max_vertices);
    if (boxed && (!best || boxed->distance <= best->distance)) return boxed;
    return best;
}

}  // namespace cdprep::convex
