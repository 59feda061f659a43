// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/flush_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cdprep/exact/triangles.h"
#include "decompose/enclose/plane.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

// The limit of tests of points against planes: once for the hull's, once for the surface's. Beyond
// it, find_hull_error() searches for the bound.
constexpr std::size_t kMostTests = 4'000'000;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Plane plane_of(const Double3& a, const Double3& b, const Double3& c) {
    const Double3 n = mesh::cross(mesh::minus(b, a), mesh::minus(c, a));
    const double length = std::sqrt(mesh::dot(n, n));
    if (!(length > 0)) return {{0, 0, 0}, 0};
    const Double3 unit = {n.x / length, n.y / length, n.z / length};
    return {unit, mesh::dot(unit, a)};
}

class FlushHull {
public:
    FlushHull(const ConvexHull& hull, const Solid& solid) : hull_(hull), solid_(solid) {
        for (const auto& f : hull.facets) {
            Plane plane = plane_of(hull.points[f[0]], hull.points[f[1]], hull.points[f[2]]);
            // A thin facet has an arbitrary direction: the offset puts the hull behind its plane
            // anyway.
            for (const Double3& p : hull.points) {
                plane.offset = std::max(plane.offset, mesh::dot(plane.normal, p));
            }
            if (mesh::dot(plane.normal, plane.normal) > 0) planes_.push_back(plane);
        }
    }

    // Proof. Let no point of the surface be deeper in the hull H than d. Let a point c of the solid
    // be r deep, with d < r. Shrink H towards c by the share d / r. Except for its border, the
    // result is more than d deep. So it meets no surface and lies in the solid with c. No point of
    // H moved by more than d / r times its distance from c.
    [[nodiscard]] std::optional<double> bound(double deepest) {
        const Double3 middle = mesh::mean_of(hull_.points);
        double radius = kInfinity;
        for (const auto& f : hull_.facets) {
            const Corners facet = {hull_.points[f[0]], hull_.points[f[1]], hull_.points[f[2]]};
            radius = std::min(radius, exact::point_triangle_distance(middle, facet).lower);
        }
        radius -= solid_.slack();
        if (!(radius > deepest)) return std::nullopt;
        double farthest = 0;
        mesh::Box box;
        for (const Double3& p : hull_.points) {
            const Double3 away = mesh::minus(p, middle);
            farthest = std::max(farthest, std::sqrt(mesh::dot(away, away)));
            box.add(p);
        }
        double depth = 0;
        std::size_t tests = 0;
        solid_.tree().in_box(box, [&](std::uint32_t triangle) {
            if (depth > deepest || tests > kMostTests) return;
            tests += planes_.size();
            depth = std::max(depth, depth_of(solid_.tree().corners(triangle), depth));
        });
        depth += 2 * solid_.slack();
        if (depth > deepest || tests > kMostTests || !(depth < radius)) return std::nullopt;
        if (!solid_.includes(middle)) return std::nullopt;
        return depth / radius * farthest + 2 * solid_.slack();
    }

private:
    /// Returns an upper bound of how deep a point of the triangle lies in the hull, or any value up
    /// to `enough`. A ball in the hull around such a point reaches equally far to both sides of the
    /// triangle's plane.
    [[nodiscard]] double depth_of(const Corners& corners, double enough) const {
        double depth = kInfinity;
        for (const Plane& plane : planes_) {
            double most = -kInfinity;
            for (const Double3& p : corners) most = std::max(most, -height(plane, p));
            depth = std::min(depth, most);
            if (depth <= enough) return depth;
        }
        const Plane own = own_plane_of(corners);
        if (!(mesh::dot(own.normal, own.normal) > 0)) return depth;
        double above = 0;
        double below = 0;
        for (const Double3& p : hull_.points) {
            above = std::max(above, height(own, p));
            below = std::max(below, -height(own, p));
        }
        return std::min({depth, above, below});
    }

    /// Returns the plane of a triangle. The rounded one of a thin triangle has an arbitrary
    /// direction, and may miss the corners.
    [[nodiscard]] Plane own_plane_of(const Corners& corners) const {
        const Plane plane = plane_of(corners[0], corners[1], corners[2]);
        const bool is_right = std::all_of(corners.begin(), corners.end(), [&](const Double3& p) {
            return std::fabs(height(plane, p)) <= solid_.slack();
        });
        return is_right ? plane : exact_plane(corners[0], corners[1], corners[2]);
    }

    const ConvexHull& hull_;
    const Solid& solid_;
    std::vector<Plane> planes_;
};

}  // namespace

std::optional<double> bound_flush(const ConvexHull& hull, const Solid& solid, double deepest) {
    if (hull.dimension != 3 || !solid.encloses()) return std::nullopt;
    if (hull.facets.size() > kMostTests / hull.points.size()) return std::nullopt;
    return FlushHull(hull, solid).bound(deepest);
}

}  // namespace cdprep::convex
