// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "decompose/surface/surface_pieces.h"
#include "hull/convex_hull.h"
#include "support/exact_rational.h"
#include "unit/tools/hull_flaw.h"

namespace cdprep::test {

inline constexpr std::array kPieceOrders = {
    convex::PieceOrder::greedy, convex::PieceOrder::depth_first, convex::PieceOrder::breadth_first,
    convex::PieceOrder::cresting};

/// The vertices of a piece, ascending.
inline std::vector<std::uint32_t> piece_vertices(const mesh::Mesh& mesh,
                                                 std::span<const std::uint32_t> triangles) {
    std::set<std::uint32_t> all;
    for (const std::uint32_t t : triangles) {
        all.insert(mesh.triangles[t].vertex.begin(), mesh.triangles[t].vertex.end());
    }
    return {all.begin(), all.end()};
}

inline std::vector<Double3> piece_points(const mesh::Mesh& mesh,
                                         std::span<const std::uint32_t> triangles) {
    std::vector<Double3> points;
    for (const std::uint32_t v : piece_vertices(mesh, triangles)) {
        points.push_back(mesh.positions[v]);
    }
    return points;
}

/// Says what is wrong with the lists of pieces, or nothing: every triangle is in one piece
/// and in no other, pieces are sorted as promised.
inline std::string partition_flaw(const mesh::Mesh& mesh, const convex::SurfacePieces& pieces) {
    if (pieces.first.size() != pieces.pieces.size() + 1) return "lists of unequal length";
    if (pieces.first.front() != 0 || pieces.first.back() != mesh.triangles.size()) {
        return "lists do not end where the triangles do";
    }
    std::vector<std::uint8_t> seen(mesh.triangles.size(), 0);
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        const auto triangles = pieces.of(i);
        if (triangles.empty()) return "piece " + std::to_string(i) + " is empty";
        if (!std::is_sorted(triangles.begin(), triangles.end())) {
            return "piece " + std::to_string(i) + " is not sorted";
        }
        if (i > 0 && pieces.of(i - 1)[0] > triangles[0]) return "pieces are not sorted";
        for (const std::uint32_t t : triangles) {
            if (t >= seen.size() || seen[t] != 0) return "triangle twice, or out of range";
            seen[t] = 1;
        }
    }
    return "";
}

/// Says which triangle does not lie on the hull of its piece, or nothing: a vertex of the
/// piece is above its plane. Exact.
inline std::string hull_face_flaw(const mesh::Mesh& mesh, const convex::SurfacePieces& pieces) {
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        const std::vector<std::uint32_t> vertices = piece_vertices(mesh, pieces.of(i));
        for (const std::uint32_t t : pieces.of(i)) {
            const auto& v = mesh.triangles[t].vertex;
            const FilteredPlane plane(mesh.positions[v[0]], mesh.positions[v[1]],
                                      mesh.positions[v[2]]);
            for (const std::uint32_t vertex : vertices) {
                if (vertex == v[0] || vertex == v[1] || vertex == v[2]) continue;
                if (plane.side(mesh.positions[vertex]) > 0) {
                    return "triangle " + std::to_string(t) + " is below a vertex of piece " +
                           std::to_string(i);
                }
            }
        }
    }
    return "";
}

using RationalPoint = std::array<ExactRational, 3>;

/// How far a point is in front of a plane, in some unit.
inline ExactRational height(const ExactPlane& plane, const RationalPoint& p) {
    ExactRational sum;
    const std::array<double, 3> at = {plane.at.x, plane.at.y, plane.at.z};
    for (std::size_t k = 0; k < 3; ++k) {
        sum =
            sum + ExactRational(plane.normal[k], ExactNumber(1.0)) * (p[k] - ExactRational(at[k]));
    }
    return sum;
}

/// The part of a polygon that is not in front of a plane.
inline std::vector<RationalPoint> clipped(const std::vector<RationalPoint>& polygon,
                                          const ExactPlane& plane) {
    std::vector<RationalPoint> left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const RationalPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const ExactRational hp = height(plane, p), hq = height(plane, q);
        if (hp.sign() <= 0) left.push_back(p);
        if (hp.sign() * hq.sign() >= 0) continue;
        const ExactRational at = hp / (hp - hq);
        RationalPoint between;
        for (std::size_t k = 0; k < 3; ++k) between[k] = p[k] + at * (q[k] - p[k]);
        left.push_back(between);
    }
    return left;
}

/// A hull, ready to be asked whether triangles enter it.
class ExactBody {
public:
    explicit ExactBody(const convex::ConvexHull& hull) {
        if (hull.dimension < 3) return;
        for (const auto& f : hull.facets) {
            const std::array<Double3, 3> p = {hull.points[f[0]], hull.points[f[1]],
                                              hull.points[f[2]]};
            planes_.push_back(exact_plane(p[0], p[1], p[2]));
            filtered_.emplace_back(p[0], p[1], p[2]);
        }
    }

    /// The triangle has a point strictly inside: one plane with all its corners on it or
    /// before it says no. Else cut off what is outside, and ask whether what is left lies in
    /// no facet's plane altogether. Exact rationals, and slow.
    [[nodiscard]] bool is_entered_by(const std::array<Double3, 3>& triangle) const {
        if (planes_.empty()) return false;
        for (const FilteredPlane& plane : filtered_) {
            if (std::all_of(triangle.begin(), triangle.end(),
                            [&](const Double3& p) { return plane.side(p) >= 0; })) {
                return false;
            }
        }
        std::vector<RationalPoint> left;
        for (const Double3& p : triangle) left.push_back({p.x, p.y, p.z});
        for (const ExactPlane& plane : planes_) {
            left = clipped(left, plane);
            if (left.empty()) return false;
        }
        return std::all_of(planes_.begin(), planes_.end(), [&](const ExactPlane& plane) {
            return std::any_of(left.begin(), left.end(),
                               [&](const RationalPoint& p) { return height(plane, p).sign() < 0; });
        });
    }

private:
    std::vector<ExactPlane> planes_;
    std::vector<FilteredPlane> filtered_;
};

/// Says which triangle enters the hull of a piece that is said to be contained, or nothing.
/// All triangles of a mesh count, which must be one solid.
inline std::string containment_flaw(const mesh::Mesh& mesh, const convex::SurfacePieces& pieces) {
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        if (!pieces.pieces[i].contained) continue;
        const ExactBody body(convex::convex_hull(piece_points(mesh, pieces.of(i))));
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto& v = mesh.triangles[t].vertex;
            if (body.is_entered_by(
                    {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]})) {
                return "triangle " + std::to_string(t) + " enters the hull of piece " +
                       std::to_string(i);
            }
        }
    }
    return "";
}

}  // namespace cdprep::test
