// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/is_convex.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"
#include "decompose/surface/flat_turn.h"
#include "mesh/exact_volume.h"
#include "mesh/half_edges.h"

namespace cdprep::convex {
namespace {

/// The corners of a hull by position, and the corners next to each.
class HullCorners {
public:
    explicit HullCorners(const ConvexHull& hull) : hull_(hull), order_(hull.points.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
        std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return is_before(hull.points[a], hull.points[b]);
        });
        first_.assign(hull.points.size() + 1, 0);
        for (const auto& facet : hull.facets) {
            for (const std::uint32_t corner : facet) ++first_[corner + 1];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        next_.resize(3 * hull.facets.size());
        std::vector<std::uint32_t> end(first_.begin(), first_.end() - 1);
        for (const auto& facet : hull.facets) {
            for (std::size_t k = 0; k < 3; ++k) next_[end[facet[k]]++] = facet[(k + 1) % 3];
        }
    }

    /// Returns the corner at a position, or kNone.
    [[nodiscard]] std::uint32_t at(const Double3& p) const {
        const auto found = std::lower_bound(order_.begin(), order_.end(), p,
                                            [&](std::uint32_t corner, const Double3& q) {
                                                return is_before(hull_.points[corner], q);
                                            });
        if (found == order_.end() || is_before(p, hull_.points[*found])) return mesh::kNone;
        return *found;
    }
    [[nodiscard]] std::span<const std::uint32_t> around(std::uint32_t corner) const {
        return std::span(next_).subspan(first_[corner], first_[corner + 1] - first_[corner]);
    }

private:
    static bool is_before(const Double3& a, const Double3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }

    const ConvexHull& hull_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> next_;
};

/// Some triangles and their hull.
class Surface {
public:
    Surface(const mesh::Mesh& mesh, std::span<const std::uint32_t> triangles,
            const ConvexHull& hull)
        : mesh_(mesh), hull_(hull), flat_(triangles.size()) {
        for (const std::uint32_t i : triangles) list_.push_back(mesh.triangles[i]);
    }

    // The cheapest conditions come first: nearly all surfaces have a reflex edge.
    [[nodiscard]] bool is_convex() {
        return join_flat() && has_volume_of_hull() && lies_on_hull();
    }

private:
    [[nodiscard]] const Double3& at(std::uint32_t vertex) const {
        return mesh_.positions[vertex];
    }
    [[nodiscard]] Corners corners_of(std::uint32_t triangle) const {
        const auto& v = list_[triangle].vertex;
        return {at(v[0]), at(v[1]), at(v[2])};
    }

    /// Joins triangles in one plane that share an edge. Finds the turn. Returns false if the uses
    /// of an edge do not cancel, or if edges bend both ways.
    [[nodiscard]] bool join_flat() {
        const mesh::EdgeUses edges = mesh::find_edge_uses(list_, mesh_.positions.size());
        for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
            const auto uses = edges.of(edge);
            if (uses.size() != 2) return false;
            if (mesh::start_of(list_, uses[0]) == mesh::start_of(list_, uses[1])) return false;
            const Corners c = corners_of(uses[0] / 3);
            const int behind = exact::orient3d(c[0], c[1], c[2], at(mesh::apex_of(list_, uses[1])));
            if (behind * turn_ < 0) return false;
            if (behind != 0) turn_ = behind;
            if (behind == 0 && is_flat(uses[0], uses[1])) flat_.join(uses[0] / 3, uses[1] / 3);
        }
        return true;
    }

    /// Returns true if two coplanar triangles have area and face the same way.
    [[nodiscard]] bool is_flat(mesh::HalfEdge use, mesh::HalfEdge twin) const {
        const Corners c = corners_of(use / 3);
        const Corners d = corners_of(twin / 3);
        if (exact::is_degenerate(c) || exact::is_degenerate(d)) return false;
        const int axis = axis_of_turn(c[0], c[1], c[2]);
        return flat_turn(axis, c[0], c[1], c[2]) == flat_turn(axis, d[0], d[1], d[2]);
    }

    [[nodiscard]] bool has_volume_of_hull() const {
        mesh::ExactVolume difference;
        for (const mesh::Triangle& t : list_) {
            difference.add(at(t.vertex[0]), at(t.vertex[1]), at(t.vertex[2]));
        }
        // The facets of the hull are wound the other way, and so subtracted.
        const std::size_t second = turn_ < 0 ? 1 : 2;
        for (const auto& f : hull_.facets) {
            difference.add(hull_.points[f[0]], hull_.points[f[second]],
                           hull_.points[f[3 - second]]);
        }
        return difference.sign() == 0;
    }

    /// A face of the hull contains the triangles of a group if it contains one of them. A face that
    /// they cover has its corners among theirs.
    [[nodiscard]] bool lies_on_hull() {
        const HullCorners corners(hull_);
        std::vector<std::uint32_t> best(list_.size(), mesh::kNone);  // by group: a hull corner
        for (std::uint32_t i = 0; i < list_.size(); ++i) {
            std::uint32_t& chosen = best[flat_.lowest(i)];
            for (const std::uint32_t vertex : list_[i].vertex) {
                const std::uint32_t corner = corners.at(at(vertex));
                if (corner == mesh::kNone) continue;
                if (chosen == mesh::kNone ||
                    corners.around(corner).size() < corners.around(chosen).size()) {
                    chosen = corner;
                }
            }
        }
        for (std::uint32_t i = 0; i < list_.size(); ++i) {
            if (flat_.lowest(i) != i || exact::is_degenerate(corners_of(i))) continue;
            if (best[i] == mesh::kNone || !is_behind(i, corners.around(best[i]))) return false;
        }
        return true;
    }

    /// Returns true if all these hull corners are behind a triangle's plane. If they are those next
    /// to a corner in the plane, all of the hull is behind it, because it is convex.
    [[nodiscard]] bool is_behind(std::uint32_t triangle,
                                 std::span<const std::uint32_t> hull_corners) const {
        const Corners c = corners_of(triangle);
        return std::all_of(hull_corners.begin(), hull_corners.end(), [&](std::uint32_t corner) {
            return exact::orient3d(c[0], c[1], c[2], hull_.points[corner]) * turn_ >= 0;
        });
    }

    const mesh::Mesh& mesh_;
    const ConvexHull& hull_;
    std::vector<mesh::Triangle> list_;
    mesh::Groups flat_;  ///< triangles in one plane, facing one way, connected by edges
    int turn_ = 0;       ///< 1: apexes are behind, -1: inside out
};

}  // namespace

bool is_convex(const mesh::Mesh& mesh, std::span<const std::uint32_t> triangles,
               const ConvexHull& hull) {
    return hull.dimension == 3 && Surface(mesh, triangles, hull).is_convex();
}

}  // namespace cdprep::convex
