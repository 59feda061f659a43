// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/moved_distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <CGAL/AABB_triangle_primitive.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

#include "exact_within.h"
#include "point_triangle_distance.h"

namespace cdprep::mesh {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Kernel::Triangle_3>::iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr double kRelative = 1e-4;
constexpr double kOfModel = 1e-9;
constexpr std::size_t kMostPieces = 200'000;  ///< over all triangles of one direction

Kernel::Point_3 point(const Double3& p) {
    return {p.x, p.y, p.z};
}

/// Names a triangle near a point. The tree rounds: what it names need not be the nearest,
/// but the surface is no farther than that. A lower bound may then be too large, by the
/// rounding.
class Surface {
public:
    explicit Surface(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
        for (const Corners& t : triangles_) {
            shapes_.emplace_back(point(t[0]), point(t[1]), point(t[2]));
        }
        tree_.insert(shapes_.begin(), shapes_.end());
        const std::vector<Hint> hints = hints_for_queries();
        tree_.accelerate_distance_queries(hints.begin(), hints.end());
    }

    [[nodiscard]] const Corners& nearest(const Double3& p) const {
        const auto found = tree_.closest_point_and_primitive(point(p));
        return triangles_[static_cast<std::size_t>(found.second - shapes_.begin())];
    }
    [[nodiscard]] bool empty() const {
        return triangles_.empty();
    }

private:
    using Hint = std::pair<Kernel::Point_3, Primitive::Id>;

    /// First corners, each place once: CGAL's own hints, one a triangle, are cut in two
    /// until the stack ends where many are one point.
    std::vector<Hint> hints_for_queries() {
        std::vector<Hint> hints;
        for (auto shape = shapes_.begin(); shape != shapes_.end(); ++shape) {
            hints.emplace_back(shape->vertex(0), shape);
        }
        std::sort(hints.begin(), hints.end());
        const auto same_place = [](const Hint& a, const Hint& b) { return a.first == b.first; };
        hints.erase(std::unique(hints.begin(), hints.end(), same_place), hints.end());
        return hints;
    }

    std::vector<Corners> triangles_;
    mutable std::vector<Kernel::Triangle_3> shapes_;
    Tree tree_;
};

double apart(const Double3& a, const Double3& b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

Double3 middle(const Double3& a, const Double3& b) {
    return {a.x / 2 + b.x / 2, a.y / 2 + b.y / 2, a.z / 2 + b.z / 2};
}

struct Piece {
    Corners corners;
    double upper;
    bool operator<(const Piece& other) const {
        return upper < other.upper;
    }
};

/// At least the distance of a point and a triangle; 0 exactly where the point is on it.
double distance_at_most(const Double3& p, const Corners& t) {
    const PointTriangleDistance found = point_triangle_distance(p, t);
    return found.lower == 0 && is_within_exactly({&p, 1}, t, 0) ? 0 : found.upper;
}

/// Without area: the longest of its sides, as a triangle whose last two corners are one.
Corners as_segment(const Corners& c) {
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        if (apart(c[k], c[(k + 1) % 3]) > apart(c[longest], c[(longest + 1) % 3])) longest = k;
    }
    return {c[longest], c[(longest + 1) % 3], c[(longest + 1) % 3]};
}

std::vector<Corners> cut_in_middles(const Corners& c) {
    const Double3 ab = middle(c[0], c[1]);
    if (c[1] == c[2]) return {{c[0], ab, ab}, {ab, c[1], c[1]}};
    const Double3 bc = middle(c[1], c[2]), ca = middle(c[2], c[0]);
    return {{c[0], ab, ca}, {ab, c[1], bc}, {ca, bc, c[2]}, {ab, bc, ca}};
}

/// Bounds a piece. The distance to one triangle is convex: it is largest at a corner of the
/// piece, for each of the triangles that are nearest to a corner. Where they are far apart,
/// no point of the piece is farther from some corner than its longest side.
Piece bounded(const Corners& corners, const Surface& surface, double& lower) {
    double most = 0;
    std::array<Corners, 3> near;
    for (std::size_t k = 0; k < 3; ++k) {
        near[k] = surface.nearest(corners[k]);
        const PointTriangleDistance found = point_triangle_distance(corners[k], near[k]);
        most = std::max(most, distance_at_most(corners[k], near[k]));
        lower = std::max(lower, found.lower);
    }
    const double side = std::max({apart(corners[0], corners[1]), apart(corners[1], corners[2]),
                                  apart(corners[2], corners[0])});
    double upper = most + side;
    for (const Corners& t : near) {
        double to_t = 0;
        for (const Double3& corner : corners) {
            to_t = std::max(to_t, distance_at_most(corner, t));
        }
        upper = std::min(upper, to_t);
    }
    return {corners, upper};
}

/// Cuts the piece with the largest bound until it is close to what some point attains.
MovedDistance farthest(const std::vector<Corners>& triangles, const Surface& surface,
                       double diagonal) {
    MovedDistance distance;
    if (triangles.empty()) return distance;
    if (surface.empty()) {
        distance.upper = std::numeric_limits<double>::infinity();
        return distance;
    }
    std::priority_queue<Piece> pieces;
    for (const Corners& t : triangles) {
        pieces.push(bounded(is_degenerate(t) ? as_segment(t) : t, surface, distance.lower));
    }
    std::size_t left = kMostPieces;
    while (left > 0 &&
           pieces.top().upper > distance.lower * (1 + kRelative) + kOfModel * diagonal) {
        const Corners corners = pieces.top().corners;
        pieces.pop();
        for (const Corners& part : cut_in_middles(corners)) {
            pieces.push(bounded(part, surface, distance.lower));
        }
        left -= std::min<std::size_t>(left, 4);
    }
    // Middles are rounded: their pieces leave out less than this.
    distance.upper = pieces.top().upper;
    if (left < kMostPieces) distance.upper += 1e-15 * diagonal;
    distance.lower = std::min(distance.lower, distance.upper);
    return distance;
}

bool usable(const TriangleSoup& soup, const Triangle& triangle) {
    return std::all_of(triangle.vertex.begin(), triangle.vertex.end(), [&](std::uint32_t vertex) {
        const Double3& p = soup.positions[vertex];
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    });
}

template <class Mesh>
Corners corners_of(const Mesh& mesh, const Triangle& t) {
    return {mesh.positions[t.vertex[0]], mesh.positions[t.vertex[1]], mesh.positions[t.vertex[2]]};
}

bool same_corners(const Corners& a, const Corners& b) {
    return std::is_permutation(a.begin(), a.end(), b.begin());
}

Corners ordered(Corners c) {
    std::sort(c.begin(), c.end(), [](const Double3& a, const Double3& b) {
        return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    });
    return c;
}

}  // namespace

double area_of(const Corners& c) {
    const Double3 u{c[1].x - c[0].x, c[1].y - c[0].y, c[1].z - c[0].z};
    const Double3 v{c[2].x - c[0].x, c[2].y - c[0].y, c[2].z - c[0].z};
    return std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x) / 2;
}

/// The pieces that a source triangle was cut into, and how far their corners are from it.
/// The map that takes each piece to the part of the triangle that it stands for moves no
/// point farther than a corner; so where the pieces are all there, both distances are bounded.
struct Pieces {
    double area = 0;
    double farthest = 0;
};

std::vector<Pieces> find_pieces(const TriangleSoup& soup, const RepairMesh& mesh) {
    std::vector<Pieces> pieces(soup.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Origin& origin = mesh.triangle_origin[t];
        if (origin.source == kNone || !origin.step) continue;
        const Corners piece = corners_of(mesh, mesh.triangles[t]);
        const Corners whole = corners_of(soup, soup.triangles[origin.source]);
        Pieces& of = pieces[origin.source];
        of.area += area_of(piece);
        for (const Double3& corner : piece) {
            if (std::find(whole.begin(), whole.end(), corner) != whole.end()) continue;
            of.farthest = std::max(of.farthest, distance_at_most(corner, whole));
        }
    }
    return pieces;
}

MovedDistances find_moved_distances(const TriangleSoup& soup, const RepairMesh& mesh) {
    MovedDistances moved;
    std::vector<Corners> input, output, from_input, from_output;
    std::vector<bool> found(soup.triangles.size(), false);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        output.push_back(corners_of(mesh, mesh.triangles[t]));
        const std::uint32_t source = mesh.triangle_origin[t].source;
        if (source != kNone &&
            same_corners(output.back(), corners_of(soup, soup.triangles[source]))) {
            found[source] = true;
        } else if (source != kNone && usable(soup, soup.triangles[source])) {
            // The distance to one triangle is convex: no inner point is farther than a corner.
            const Corners whole = corners_of(soup, soup.triangles[source]);
            for (const Double3& corner : output.back()) {
                if (std::find(whole.begin(), whole.end(), corner) != whole.end()) continue;
                double& upper = moved.output_to_input.upper;
                upper = std::max(upper, distance_at_most(corner, whole));
            }
        } else {
            from_output.push_back(output.back());
        }
    }
    // Pieces that cover less of a triangle than its rounded area were left out in part.
    constexpr double kAllOfIt = 1 - 1e-6;
    const std::vector<Pieces> pieces = find_pieces(soup, mesh);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        if (!usable(soup, soup.triangles[t])) continue;
        input.push_back(corners_of(soup, soup.triangles[t]));
        if (found[t]) continue;
        if (pieces[t].area > 0 && pieces[t].area >= kAllOfIt * area_of(input.back())) {
            double& upper = moved.input_to_output.upper;
            upper = std::max(upper, pieces[t].farthest);
        } else {
            from_input.push_back(input.back());
        }
    }
    // What was dropped because its corners are there again is not away at all.
    if (!from_input.empty()) {
        const auto less = [](const Corners& a, const Corners& b) {
            return std::lexicographical_compare(
                a.begin(), a.end(), b.begin(), b.end(), [](const Double3& p, const Double3& q) {
                    return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
                });
        };
        std::vector<Corners> known;
        known.reserve(output.size());
        for (const Corners& c : output) known.push_back(ordered(c));
        std::sort(known.begin(), known.end(), less);
        std::erase_if(from_input, [&](const Corners& c) {
            return std::binary_search(known.begin(), known.end(), ordered(c), less);
        });
    }
    if (from_input.empty() && from_output.empty()) return moved;
    Double3 lower = input.empty() ? Double3{} : input[0][0], upper = lower;
    for (const Corners& c : input) {
        for (const Double3& p : c) {
            lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
            upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
        }
    }
    const double diagonal = apart(lower, upper);
    if (!from_input.empty()) {
        const MovedDistance rest = farthest(from_input, Surface(output), diagonal);
        moved.input_to_output.lower = rest.lower;
        moved.input_to_output.upper = std::max(moved.input_to_output.upper, rest.upper);
    }
    if (!from_output.empty()) {
        const MovedDistance rest = farthest(from_output, Surface(std::move(input)), diagonal);
        moved.output_to_input.lower = rest.lower;
        moved.output_to_input.upper = std::max(moved.output_to_input.upper, rest.upper);
    }
    return moved;
}

}  // namespace cdprep::mesh
