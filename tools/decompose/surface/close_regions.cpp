// SPDX-License-Identifier: GPL-3.0-or-later
#include "cdprep/advanced/parallel_for.h"
#include "decompose/surface/patch_steps.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "cdprep/exact/predicates.h"
#include "decompose/surface/flat_turn.h"
#include "hull/convex_hull.h"

namespace cdprep::convex {
namespace {

using mesh::HalfEdge;
using mesh::kNone;

constexpr std::size_t kLeastRegion = 64;         ///< triangles; smaller regions are quickly merged
constexpr std::size_t kLeastPolygon = 3;         ///< triangles; two merge over their common edge
constexpr std::size_t kMostOutline = 4096;       ///< corners; the test is quadratic in them
constexpr std::uint64_t kMostTests = 1U << 28U;  ///< of a point against a plane, per region

/// Triangles in groups.
struct Grouped {
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> first;

    [[nodiscard]] std::size_t count() const {
        return first.size() - 1;
    }
    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t group) const {
        return std::span(triangles).subspan(first[group], first[group + 1] - first[group]);
    }
};

/// Returns triangles connected by edges for which `joins` is true; groups by lowest triangle.
template <class Joins>
Grouped connected(const PatchRules& rules, Joins joins) {
    const auto count = static_cast<std::uint32_t>(rules.mesh.triangles.size());
    mesh::Groups groups(count);
    for (HalfEdge h = 0; h < 3 * count; ++h) {
        const HalfEdge twin = rules.edges.twin[h];
        if (twin != kNone && twin > h && joins(rules.edges.kind[h])) groups.join(h / 3, twin / 3);
    }
    std::vector<std::uint32_t> size(count, 0), next(count, 0);
    for (std::uint32_t t = 0; t < count; ++t) ++size[groups.lowest(t)];
    Grouped result;
    result.triangles.resize(count);
    for (std::uint32_t t = 0, sum = 0; t < count; ++t) {
        if (size[t] == 0) continue;
        result.first.push_back(next[t] = sum);
        sum += size[t];
    }
    result.first.push_back(count);
    for (std::uint32_t t = 0; t < count; ++t) result.triangles[next[groups.lowest(t)]++] = t;
    return result;
}

/// Calls body(group) for all groups, in parallel.
template <class Body>
void for_groups(const Grouped& groups, ParallelFor parallel_for, Body body) {
    constexpr std::size_t kAtATime = 1024;  // groups per task: changes no result
    for_chunks(groups.count(), kAtATime, parallel_for, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) body(i);
    });
}

/// Returns the vertices of some triangles, ascending.
std::vector<std::uint32_t> vertices_of(const mesh::Mesh& mesh,
                                       std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> all;
    all.reserve(3 * triangles.size());
    for (const std::uint32_t t : triangles) {
        all.insert(all.end(), mesh.triangles[t].vertex.begin(), mesh.triangles[t].vertex.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

/// One region and its hull.
class Region {
public:
    Region(const PatchRules& rules, std::span<const std::uint32_t> triangles)
        : rules_(rules), triangles_(triangles) {}

    /// Returns true if all its triangles lie on its hull.
    [[nodiscard]] bool is_convex() {
        vertices_ = vertices_of(rules_.mesh, triangles_);
        if (!is_below_extremes()) return false;
        std::vector<Double3> points;
        for (const std::uint32_t v : vertices_) points.push_back(rules_.mesh.positions[v]);
        hull_ = convex_hull(points);
        find_neighbours();
        return std::all_of(triangles_.begin(), triangles_.end(),
                           [&](std::uint32_t t) { return is_on_hull(t); });
    }

    /// Returns true if the hull stays in the solid, or no solid applies. False for a flat region of
    /// a solid: fill_polygons() treats it. Call is_convex() first.
    [[nodiscard]] bool is_inside() {
        const std::uint32_t some = triangles_[0];
        if (!rules_.solids.is_solid(some)) return true;
        if (is_flat()) return false;
        GrowingHull body;
        body.adopt(hull_.points, hull_.facets);
        const auto is_own = [&](std::uint32_t t) {
            return std::binary_search(triangles_.begin(), triangles_.end(), t);
        };
        return rules_.solids.contains(body, some, is_own, tests_);
    }
    [[nodiscard]] bool is_flat() const {
        return hull_.dimension < 3;
    }

private:
    /// A cheap test with six extreme vertices. Most regions of scans fail it.
    [[nodiscard]] bool is_below_extremes() const {
        std::array<std::uint32_t, 6> extreme;
        extreme.fill(vertices_[0]);
        for (const std::uint32_t v : vertices_) {
            const Double3& p = rules_.mesh.positions[v];
            const std::array<double, 3> at = {p.x, p.y, p.z};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto along = [&](std::uint32_t u) {
                    const Double3& q = rules_.mesh.positions[u];
                    return std::array<double, 3>{q.x, q.y, q.z}[axis];
                };
                if (at[axis] < along(extreme[2 * axis])) extreme[2 * axis] = v;
                if (at[axis] > along(extreme[2 * axis + 1])) extreme[2 * axis + 1] = v;
            }
        }
        return std::all_of(triangles_.begin(), triangles_.end(), [&](std::uint32_t t) {
            return std::all_of(extreme.begin(), extreme.end(), [&](std::uint32_t v) {
                return is_behind(t, rules_.mesh.positions[v]);
            });
        });
    }
    [[nodiscard]] bool is_behind(std::uint32_t triangle, const Double3& p) const {
        const Corners c = rules_.solids.corners_of(triangle);
        return exact::orient3d(c[0], c[1], c[2], p) >= 0;
    }

    /// Finds the hull corners adjacent to each corner of the hull.
    void find_neighbours() {
        first_.assign(hull_.points.size() + 1, 0);
        for (const auto& facet : hull_.facets) {
            for (const std::uint32_t corner : facet) ++first_[corner + 1];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        neighbours_.resize(3 * hull_.facets.size());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (const auto& facet : hull_.facets) {
            for (std::size_t k = 0; k < 3; ++k) {
                neighbours_[next[facet[k]]++] = facet[(k + 1) % 3];
            }
        }
    }

    // Returns true if the triangle lies on the hull. Take a hull corner in the triangle's plane. If
    // no adjacent corner is above the plane, none is, because the hull is convex. A triangle
    // without such a corner is tested against all corners.
    [[nodiscard]] bool is_on_hull(std::uint32_t triangle) {
        std::uint32_t best = kNone;
        for (const std::uint32_t v : rules_.mesh.triangles[triangle].vertex) {
            const std::uint32_t corner = corner_of(v);
            if (corner == kNone) continue;
            if (best == kNone || degree(corner) < degree(best)) best = corner;
        }
        const std::size_t count = best == kNone ? hull_.points.size() : degree(best);
        if (tests_ < count) return false;
        tests_ -= count;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t corner = best == kNone ? i : neighbours_[first_[best] + i];
            if (!is_behind(triangle, hull_.points[corner])) return false;
        }
        return true;
    }
    [[nodiscard]] std::uint32_t degree(std::uint32_t corner) const {
        return first_[corner + 1] - first_[corner];
    }
    /// Returns the hull's number of a vertex, or kNone. Corners are in the order of vertices_.
    [[nodiscard]] std::uint32_t corner_of(std::uint32_t vertex) const {
        const auto place = std::lower_bound(vertices_.begin(), vertices_.end(), vertex);
        const auto number = static_cast<std::uint32_t>(place - vertices_.begin());
        const auto& numbers = hull_.numbers;
        const auto found = std::lower_bound(numbers.begin(), numbers.end(), number);
        if (found == numbers.end() || *found != number) return kNone;
        return static_cast<std::uint32_t>(found - numbers.begin());
    }

    const PatchRules& rules_;
    std::span<const std::uint32_t> triangles_;
    std::vector<std::uint32_t> vertices_;
    ConvexHull hull_;
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> neighbours_;
    std::uint64_t tests_ = kMostTests;
};

/// Visits the half-edges of triangles until visit() returns true.
template <class Visit>
bool any_half_edge(std::span<const std::uint32_t> triangles, Visit visit) {
    return std::any_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
        return visit(3 * t) || visit(3 * t + 1) || visit(3 * t + 2);
    });
}

/// The outline of coplanar triangles.
class Polygon {
public:
    Polygon(const PatchRules& rules, std::span<const std::uint32_t> triangles) : rules_(rules) {
        const Corners c = rules.solids.corners_of(triangles[0]);
        axis_ = axis_of_turn(c[0], c[1], c[2]);
        turn_ = flat_turn(axis_, c[0], c[1], c[2]);
        for (const std::uint32_t t : triangles) {
            for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
                if (rules.edges.twin[h] == kNone || rules.edges.kind[h] != EdgeKind::flat) {
                    outline_.push_back(h);
                }
            }
        }
    }
    [[nodiscard]] bool is_convex() const {
        if (outline_.size() > kMostOutline) return false;
        for (const HalfEdge side : outline_) {
            for (const HalfEdge other : outline_) {
                const std::uint32_t vertex = mesh::start_of(rules_.mesh.triangles, other);
                if (turn_of(side, vertex) == -turn_) return false;
            }
        }
        return true;
    }
    /// Returns the vertices at which the outline bends.
    [[nodiscard]] std::vector<std::uint32_t> corners() const {
        const std::span triangles(rules_.mesh.triangles);
        std::vector<std::uint32_t> found;
        for (const HalfEdge side : outline_) {
            for (const HalfEdge next : outline_) {
                if (mesh::start_of(triangles, next) != mesh::end_of(triangles, side)) continue;
                if (turn_of(side, mesh::end_of(triangles, next)) == 0) continue;
                found.push_back(mesh::end_of(triangles, side));
            }
        }
        return found;
    }

private:
    [[nodiscard]] int turn_of(HalfEdge side, std::uint32_t vertex) const {
        const auto at = [&](std::uint32_t v) { return rules_.mesh.positions[v]; };
        const std::span triangles(rules_.mesh.triangles);
        return flat_turn(axis_, at(mesh::start_of(triangles, side)),
                         at(mesh::end_of(triangles, side)), at(vertex));
    }

    const PatchRules& rules_;
    int axis_;
    int turn_;
    std::vector<HalfEdge> outline_;
};

}  // namespace

void close_convex_regions(const PatchRules& rules, PatchSet& patches, ParallelFor parallel_for) {
    const auto& kind = rules.edges.kind;
    const Grouped regions = connected(rules, [](EdgeKind k) { return k != EdgeKind::reflex; });
    const auto close = [&](std::size_t i) {
        const auto triangles = regions.of(i);
        const auto is_flat = [&](HalfEdge h) { return kind[h] == EdgeKind::flat; };
        const auto goes_on = [&](HalfEdge h) { return kind[h] == EdgeKind::reflex; };
        if (triangles.size() < kLeastPolygon) return;
        if (triangles.size() < kLeastRegion && !any_half_edge(triangles, is_flat)) return;
        if (!rules.keeps_inside && any_half_edge(triangles, goes_on)) return;
        Region region(rules, triangles);
        if (!region.is_convex()) return;
        const bool is_inside = region.is_inside();
        if (!is_inside && (rules.keeps_inside || region.is_flat())) return;
        patches.close(triangles, is_inside ? Containment::inside : Containment::outside);
    };
    for_groups(regions, parallel_for, close);
}

void fill_polygons(const PatchRules& rules, PatchSet& patches, ParallelFor parallel_for) {
    const Grouped polygons = connected(rules, [](EdgeKind k) { return k == EdgeKind::flat; });
    const auto fill = [&](std::size_t i) {
        const auto triangles = polygons.of(i);
        if (triangles.size() < kLeastPolygon) return;
        if (patches.patch_of(triangles[0]) == patches.patch_of(triangles[1])) return;
        const Polygon polygon(rules, triangles);
        if (polygon.is_convex()) patches.join_polygon(triangles, polygon.corners());
    };
    for_groups(polygons, parallel_for, fill);
}

}  // namespace cdprep::convex
