// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/hull_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "cdprep/exact/triangles.h"
#include "decompose/enclose/flush_bound.h"
#include "decompose/enclose/plane.h"
#include "decompose/enclose/search_scale.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::middle_of;

constexpr std::size_t kMostDepthTests = 20'000'000;  ///< of triangles against planes
constexpr std::size_t kTestsOfCell = 500;            ///< that cost as much as one cell
constexpr double kSkin = 0.02;   ///< of the error: the most that bounds of the inside may add
constexpr double kFlush = 1e-6;  ///< of the diagonal: points this near count as on the surface

/// A simplex of 1 to 3 corners; `upper` bounds the distance of its points.
struct Cell {
    std::array<Double3, 3> corner;
    std::size_t count;
    double upper;
    std::uint32_t near;  ///< a triangle near it
    bool outside;        ///< known to lie outside as a whole
    bool operator<(const Cell& other) const {
        return upper < other.upper;
    }
};

class ErrorSearch {
public:
    ErrorSearch(const Solid& solid, const HullErrorOptions& options)
        : solid_(solid), options_(options) {}

    HullError run(const ConvexHull& hull) {
        const auto flush = bound_flush(hull, solid_, kFlush * solid_.diagonal());
        if (flush && *flush <= std::max(options_.enough, kFlush * solid_.diagonal())) {
            error_.upper = *flush;
            return error_;
        }
        for (const Cell& cell : cells_under(hull)) push(cell);
        while (!heap_.empty() && !is_good_enough()) {
            std::pop_heap(heap_.begin(), heap_.end());
            const Cell cell = heap_.back();
            heap_.pop_back();
            halve(cell);
        }
        if (!heap_.empty()) error_.upper = std::max(error_.upper, heap_.front().upper);
        if (hull.dimension == 3) look_inside(hull);
        // Cells meet at rounded middles, and distances are rounded: the slack covers both.
        if (error_.upper > 0) error_.upper += solid_.slack();
        return error_;
    }

private:
    [[nodiscard]] bool is_good_enough() const {
        const double upper = heap_.front().upper;
        // Half is left for the inside: facets on the surface always have a bound above 0.
        return error_.lower > options_.too_much || error_.cells >= options_.most_cells / 2 ||
               upper <= prune_below();
    }
    /// Returns the bound below which a cell is not refined.
    [[nodiscard]] double prune_below() const {
        return std::max(options_.enough, error_.lower * (1 + options_.relative));
    }

    [[nodiscard]] std::vector<Cell> cells_under(const ConvexHull& hull) const {
        constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
        const auto& p = hull.points;
        std::vector<Cell> cells;
        if (hull.dimension < 0) return cells;
        if (hull.dimension < 2) {
            cells.push_back({{p.front(), p.back()}, p.size(), 0, kNone, false});
            return cells;
        }
        for (const auto& f : hull.facets) {
            cells.push_back({{p[f[0]], p[f[1]], p[f[2]]}, 3, 0, kNone, false});
        }
        return cells;
    }

    /// Finds the nearest triangle. An unusually expensive search counts as several cells.
    TriangleTree::Nearest nearest(const Double3& p, std::uint32_t hint) {
        const TriangleTree::Nearest near = solid_.tree().nearest(p, hint);
        error_.cells += near.weight() - 1;
        return near;
    }

    /// Bounds a cell and keeps it unless its bound is within prune_below().
    void push(Cell cell) {
        ++error_.cells;
        const std::span c = std::span(cell.corner).first(cell.count);
        const Double3 at = mesh::mean_of(c);
        double radius = 0;
        for (const Double3& corner : c)
            radius = std::max(radius, mesh::euclidean_distance(at, corner));
        radius += solid_.slack();
        const TriangleTree::Nearest near = nearest(at, cell.near);
        cell.near = near.triangle;
        const bool one_sided = near.distance > radius + solid_.slack();
        if (one_sided && !cell.outside) {
            if (solid_.includes(at)) return;
            cell.outside = true;
        }
        const Corners& t = solid_.tree().corners(near.triangle);
        cell.upper = exact::point_triangle_distance(at, t).upper + radius;
        if (cell.upper > prune_below()) {
            cell.upper = std::min(cell.upper, bound_by_corners(c, near.triangle));
        }
        if (near.distance > error_.lower && (cell.outside || !solid_.includes(at))) {
            error_.lower = near.distance;
            error_.worst = at;
        }
        if (cell.upper <= prune_below()) {
            error_.upper = std::max(error_.upper, cell.upper);
            return;
        }
        heap_.push_back(cell);
        std::push_heap(heap_.begin(), heap_.end());
    }

    /// Returns an upper bound of the distance from the surface of any point in the corners' hull.
    /// The distance to one triangle is convex. So is the mean of the distances to two, and the
    /// nearer one does not exceed it. Midway between two walls this bound is good.
    [[nodiscard]] double bound_by_corners(std::span<const Double3> corners,
                                          std::uint32_t triangle) {
        const Corners& t = solid_.tree().corners(triangle);
        std::array<double, 8> to_first{};
        std::size_t worst = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            to_first[i] = exact::point_triangle_distance(corners[i], t).upper;
            if (to_first[i] > to_first[worst]) worst = i;
        }
        const std::uint32_t other = nearest(corners[worst], triangle).triangle;
        if (other == triangle) return to_first[worst];
        const Corners& u = solid_.tree().corners(other);
        double of_both = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const double to_second = exact::point_triangle_distance(corners[i], u).upper;
            of_both = std::max(of_both, to_first[i] / 2 + to_second / 2);
        }
        return std::min(to_first[worst], of_both) + solid_.slack();
    }

    void halve(const Cell& cell) {
        std::size_t from = 0;
        std::size_t to = 1;
        double longest = -1;
        for (std::size_t i = 0; i < cell.count; ++i) {
            for (std::size_t k = i + 1; k < cell.count; ++k) {
                const double length = mesh::euclidean_distance(cell.corner[i], cell.corner[k]);
                if (length <= longest) continue;
                longest = length;
                from = i;
                to = k;
            }
        }
        const Double3 cut = middle_of(cell.corner[from], cell.corner[to]);
        for (const std::size_t end : {from, to}) {
            Cell half = cell;
            half.corner[end] = cut;
            push(half);
        }
    }

    /// A cube that may contain points deep in the hull.
    struct Cube {
        Double3 centre;
        double half;
        std::vector<std::uint32_t> planes;  ///< except those that it lies well behind
        std::uint32_t near;
        bool outside;
        double bound;
        bool operator<(const Cube& other) const {
            return bound < other.bound;
        }
    };

    /// Returns the planes of the facets, right up to less than slack(). So no point of the hull is
    /// more than slack() above one of them. A point that is deeper than `skin` lies in a ball of
    /// that radius in the hull, and so below all planes by `skin`, up to slack(). A thin facet
    /// would have a plane of any direction, which cuts the hull, if its normal were rounded.
    ///
    /// A facet whose normal underflows has no plane. The bounds hold without it: fewer cubes are
    /// left out, and no depth becomes less.
    static std::vector<Plane> planes_of(const ConvexHull& hull) {
        std::vector<Plane> planes;
        for (const auto& f : hull.facets) {
            const Plane plane =
                exact_plane(hull.points[f[0]], hull.points[f[1]], hull.points[f[2]]);
            if (mesh::dot(plane.normal, plane.normal) > 0) planes.push_back(plane);
        }
        return planes;
    }

    /// Bounds the distance inside the hull. Points at most `skin` deep are farther from the solid
    /// than the surface by at most `skin`. The others lie in cubes, which are cut until their bound
    /// is no higher. Only this step detects cavities and pockets.
    void look_inside(const ConvexHull& hull) {
        const double skin = kSkin * std::max(error_.upper, options_.enough);
        const double most = error_.upper + skin;
        mesh::Box box;
        for (const Double3& p : hull.points) box.add(p);
        const std::vector<Plane> planes = planes_of(hull);
        Cube root{middle_of(box.lower, box.upper), box.diagonal() / 2, {}, 0, false, 0};
        root.planes.resize(planes.size());
        std::iota(root.planes.begin(), root.planes.end(), 0U);
        const double shallow = bound_above_surface(hull, planes, box);
        if (shallow <= std::max(most, prune_below())) {
            error_.upper = std::max(most, shallow);
            return;
        }
        // The cube with the greatest bound comes first: what it yields saves most others.
        std::vector<Cube> heap;
        double highest = most;
        const auto push = [&](Cube cube) {
            cube.bound = bound_of(cube, planes, skin);
            if (cube.bound <= std::max(most, prune_below())) {
                highest = std::max(highest, cube.bound);
                return;
            }
            heap.push_back(std::move(cube));
            std::push_heap(heap.begin(), heap.end());
        };
        push(std::move(root));
        while (!heap.empty() && error_.cells < options_.most_cells &&
               error_.lower <= options_.too_much &&
               heap.front().bound > std::max(most, prune_below())) {
            std::pop_heap(heap.begin(), heap.end());
            const Cube cube = std::move(heap.back());
            heap.pop_back();
            const double quarter = cube.half / 2;
            for (unsigned k = 0; k < 8; ++k) {
                const Double3& c = cube.centre;
                push({{c.x + ((k & 1U) == 0 ? -quarter : quarter),
                       c.y + ((k & 2U) == 0 ? -quarter : quarter),
                       c.z + ((k & 4U) == 0 ? -quarter : quarter)},
                      quarter,
                      cube.planes,
                      cube.near,
                      cube.outside,
                      0});
            }
        }
        if (!heap.empty()) highest = std::max(highest, heap.front().bound);
        error_.upper = std::min(highest, shallow);
    }

    /// Returns an upper bound of the distance of the hull's points from the solid. It works if the
    /// surface does not enter the hull deeply. All points deeper than the surface are then inside
    /// the solid if one is. The other points are near the hull's own surface. This bounds nearly
    /// convex solids without the many cubes needed to fill them. Infinite otherwise.
    [[nodiscard]] double bound_above_surface(const ConvexHull& hull, std::span<const Plane> planes,
                                             const mesh::Box& box) {
        constexpr double kNothing = std::numeric_limits<double>::infinity();
        if (!solid_.encloses()) return kNothing;
        constexpr double kNone = -std::numeric_limits<double>::infinity();
        const Double3 at = mesh::mean_of(hull.points);
        std::size_t shallowest = 0;
        const double deepest = depth_of({&at, 1}, planes, kNone, shallowest);
        double depth = 0;
        std::size_t tests = 0;
        const std::size_t most = std::min(kMostDepthTests, kTestsOfCell * options_.most_cells);
        solid_.tree().in_box(box, [&](std::uint32_t triangle) {
            if (depth >= deepest || tests > most) return;
            tests += planes.size();
            depth = std::max(depth,
                             depth_of(solid_.tree().corners(triangle), planes, depth, shallowest));
        });
        error_.tests += tests;
        depth += 2 * solid_.slack();
        if (depth >= deepest || tests > most || !solid_.includes(at)) return kNothing;
        return error_.upper + depth;
    }

    /// Returns an upper bound of how deep any point of the corners' hull lies behind all planes.
    /// The bound may be any value up to `enough` if no point is deeper than that. `shallowest`, the
    /// last plane with the least depth, is tested first: nearby corners usually share it.
    static double depth_of(std::span<const Double3> corners, std::span<const Plane> planes,
                           double enough, std::size_t& shallowest) {
        const auto below = [&](const Plane& plane) {
            double most = -std::numeric_limits<double>::infinity();
            for (const Double3& p : corners) {
                most = std::max(most, plane.offset - mesh::dot(plane.normal, p));
            }
            return most;
        };
        double depth = std::numeric_limits<double>::infinity();
        if (shallowest < planes.size()) depth = below(planes[shallowest]);
        for (std::size_t i = 0; i < planes.size() && depth > enough; ++i) {
            const double most = below(planes[i]);
            if (most >= depth) continue;
            depth = most;
            shallowest = i;
        }
        return depth;
    }

    /// Returns an upper bound of the distance of the cube's points that are deep in the hull; 0 if
    /// it has none. Drops planes that the cube lies well behind.
    double bound_of(Cube& cube, std::span<const Plane> planes, double skin) {
        ++error_.cells;
        const Double3& c = cube.centre;
        bool is_within = true;
        std::vector<std::uint32_t> kept;
        for (const std::uint32_t i : cube.planes) {
            const Double3& n = planes[i].normal;
            const double height = mesh::dot(n, c) - planes[i].offset;
            const double reach = cube.half * (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
            if (height - reach > -skin + solid_.slack()) return 0;
            if (height > 0) is_within = false;
            if (height + reach > -skin - solid_.slack()) kept.push_back(i);
        }
        cube.planes = std::move(kept);
        const double radius = std::sqrt(3.0) * cube.half + solid_.slack();
        const TriangleTree::Nearest near = nearest(c, cube.near);
        cube.near = near.triangle;
        if (near.distance > radius + solid_.slack() && !cube.outside) {
            if (solid_.includes(c)) return 0;
            cube.outside = true;
        }
        if (is_within && near.distance > error_.lower && (cube.outside || !solid_.includes(c))) {
            error_.lower = near.distance;
            error_.worst = c;
        }
        const double by_radius = near.distance + radius + solid_.slack();
        if (by_radius <= prune_below()) return by_radius;
        std::array<Double3, 8> corners;
        for (unsigned k = 0; k < 8; ++k) {
            corners[k] = {c.x + ((k & 1U) == 0 ? -cube.half : cube.half),
                          c.y + ((k & 2U) == 0 ? -cube.half : cube.half),
                          c.z + ((k & 4U) == 0 ? -cube.half : cube.half)};
        }
        return std::min(by_radius, bound_by_corners(corners, near.triangle));
    }

    const Solid& solid_;
    const HullErrorOptions& options_;
    HullError error_;
    std::vector<Cell> heap_;
};

}  // namespace

HullError find_hull_error(const ConvexHull& hull, const Solid& solid,
                          const HullErrorOptions& options) {
    return ErrorSearch(solid, options).run(hull);
}

HullError find_hull_error(const ConvexHull& hull, const mesh::Mesh& mesh, Reference reference,
                          ParallelFor parallel_for) {
    std::vector<Double3> all = mesh.positions;
    all.insert(all.end(), hull.points.begin(), hull.points.end());
    const SearchScale scale(all);
    const Solid solid(scale.inwards(mesh), reference, parallel_for);
    return scale.outwards(find_hull_error(scale.inwards(hull), solid));
}

}  // namespace cdprep::convex
