// SPDX-License-Identifier: MIT
#include "pieces/ways_out.h"

#include <algorithm>

#include "core/numbers.h"
#include "exact/box3.h"

// The bound. Let u = 2^-53. Let A and B be the hulls of the corners as they are moved. Let A' and
// B' be those of the corners as exact arithmetic would move them. An affine map keeps the faces of
// a polytope, so those of A' and B' are known. Each corner is off by at most e_A or e_B. So the
// depth of A and B differs from that of A' and B' by at most e_A + e_B. Let R be the largest
// distance between two corners. A normal computed from rounded corners is off by an angle d. The
// reach of A' - B' along it is then off by at most d R.
//
// shortest_way_by_faces() needs a bound from above. The plane of a face of A is off by e_A. So is
// the end of A, and that of B by e_B. The error of a face's normal counts twice what corners add to
// it, which covers the second e_A.
//
// The nearest point of the border of A' - B' lies in the face whose plane is nearest. If two edges
// make that face, they come as near to each other as the plane is to the origin. So edges that are
// farther apart than a known way out need not be tested where A and B meet.
//
// Edges of A' and B' at a small angle t have no certain normal, and are left out. Their face is no
// nearer than another by more than 2 t R. The normals along which A' ends at its edge form an arc.
// Along them, its points reach c cos(phi - phi_0) over those of the other edge. This is least at
// one end of the part that both arcs share, up to t R. That end is the normal of a face of A', or
// one of B' up to another t R.

namespace cdprep {
namespace {

/// The share of the size of both hulls within which two ways are equally long up to rounding.
constexpr double kTie = 1e-13;
/// The most pairs of a corner with a face that are tested: more take as long as a search.
constexpr std::size_t kMostTests = 1600;
/// How many times as far as the shortest way along a face edges may be apart. Those of the shortest
/// way of all are no farther apart than its length. The others are for ways that do not snag.
constexpr double kFar = 2;

double highest(std::span<const Double3> corners, const Double3& direction) {
    double most = -kInfinity;
    for (const Double3& p : corners) most = std::max(most, dot(direction, p));
    return most;
}

Box3 box_of(const PieceShape& shape) {
    Box3 box = {shape.corners()[0], shape.corners()[0]};
    for (const Double3& p : shape.corners()) {
        box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y),
                     std::min(box.lower.z, p.z)};
        box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y),
                     std::max(box.upper.z, p.z)};
    }
    return box;
}

struct NearEdge {
    Double3 from;
    Double3 along;
    Double3 left;   ///< from `from` to a corner of the face to the left
    Double3 right;  ///< and to the right
    double length;  ///< of `along`
    std::uint8_t place;
};

/// The edges of a piece that are not far from a box.
class NearEdges {
public:
    NearEdges(const PieceShape& shape, const Box3& box, double far) noexcept {
        const std::span<const Double3> corners = shape.corners();
        for (std::size_t i = 0; i < shape.edges().size(); ++i) {
            const PieceShape::Edge& edge = shape.edges()[i];
            const Double3 &from = corners[edge.from], &to = corners[edge.to];
            if (axis_gap(box_around_both(from, to), box) > far) continue;
            const Double3 along = to - from;
            edge_[count_++] = {from,
                               along,
                               corners[edge.left] - from,
                               corners[edge.right] - from,
                               length(along),
                               static_cast<std::uint8_t>(i)};
            error_ = std::max(error_, 2 * shape.position_error() / edge_[count_ - 1].length);
        }
        error_ += 4 * kUnit;
    }
    [[nodiscard]] std::span<const NearEdge> all() const noexcept {
        return std::span(edge_).first(count_);
    }
    /// Returns the largest error of the direction of an edge, relative.
    [[nodiscard]] double error() const noexcept {
        return error_;
    }

private:
    static Box3 box_around_both(const Double3& p, const Double3& q) noexcept {
        return {{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
                {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}};
    }

    std::size_t count_ = 0;
    double error_ = 0;
    std::array<NearEdge, PieceShape::kMostEdges> edge_;
};

/// Returns how far the other hull reaches behind a face.
double way_through(const PieceShape& of, const PieceShape::Face& face, const PieceShape& other) {
    return dot(face.normal, of.corners()[face.corner]) + highest(other.corners(), -face.normal);
}

}  // namespace

double shortest_way_by_faces(const PieceShape& a, const PieceShape& b) noexcept {
    const double reach = a.reach() + b.reach();
    double shortest = kInfinity;
    const auto look = [&](const PieceShape& of, const PieceShape& other) {
        for (const PieceShape::Face& face : of.faces()) {
            shortest = std::min(shortest, way_through(of, face, other) + face.error * reach);
        }
    };
    look(a, b);
    look(b, a);
    return shortest + a.position_error() + b.position_error() + 16 * kUnit * reach;
}

bool WaysOut::find(const PieceShape& a, const PieceShape& b, bool they_meet) noexcept {
    if (a.faces().size() * b.corners().size() + b.faces().size() * a.corners().size() +
            a.edges().size() + b.edges().size() >
        kMostTests) {
        return false;
    }
    count_ = 0;
    skipped_angle_ = 0;
    least_ = kInfinity;
    position_error_ = a.position_error() + b.position_error();
    reach_ = a.reach() + b.reach();
    add_faces(a, b, WayKind::face_a);
    add_faces(b, a, WayKind::face_b);
    add_edges(a, b, they_meet ? kFar * std::max(0.0, way_[0].length) + kTie * reach_ : kInfinity);
    least_ -= position_error_ + (2 * skipped_angle_ + 16 * kUnit) * reach_;
    return true;
}

void WaysOut::add(const WayOut& way) noexcept {
    const double order = way.length + (way.kind == WayKind::edges ? kTie * reach_ : 0);
    if (count_ == kMost && !(order < order_[kMost - 1])) return;
    std::size_t i = count_ < kMost ? count_++ : kMost - 1;
    for (; i > 0 && order < order_[i - 1]; --i) {
        way_[i] = way_[i - 1];
        order_[i] = order_[i - 1];
    }
    way_[i] = way;
    order_[i] = order;
}

/// Adds the normals of the faces of one hull.
void WaysOut::add_faces(const PieceShape& of, const PieceShape& other, WayKind kind) noexcept {
    for (std::size_t i = 0; i < of.faces().size(); ++i) {
        const PieceShape::Face& face = of.faces()[i];
        const double way = way_through(of, face, other);
        least_ = std::min(least_, way - face.error * reach_);
        const auto place = static_cast<std::uint8_t>(i);
        add({kind == WayKind::face_a ? face.normal : -face.normal, way, kind, place, place});
    }
}

/// Adds the directions across two edges along which each is the end of its hull. One next to the
/// normal of a face, up to rounding, counts for the bound alone. Edges farther apart than `far` are
/// left out.
void WaysOut::add_edges(const PieceShape& a, const PieceShape& b, double far) noexcept {
    NearEdges near_a(a, box_of(b), far), near_b(b, box_of(a), far);
    const double error = near_a.error() + near_b.error() + 8 * kUnit;
    const double error_of_height = 4 * (error * reach_ + position_error_);
    for (const NearEdge& of_a : near_a.all()) {
        for (const NearEdge& of_b : near_b.all()) {
            Double3 n = cross(of_a.along, of_b.along);
            const double product = of_a.length * of_b.length;
            const double slack = product * error_of_height;
            // Most pairs end here: one corner is above the plane of both edges, another one below.
            const double left = dot(n, of_a.left), right = dot(n, of_a.right);
            if (std::max(left, right) > slack && std::min(left, right) < -slack) continue;
            const double other_left = -dot(n, of_b.left), other_right = -dot(n, of_b.right);
            const double most = std::max({left, right, other_left, other_right});
            const double least = std::min({left, right, other_left, other_right});
            if (most > slack && least < -slack) continue;
            const double size = length(n);
            const double angle = size / product + error;
            if (2 * angle * size <= error * product) {
                skipped_angle_ = std::max(skipped_angle_, angle);
                continue;
            }
            const double sign = most <= slack ? 1 : -1;
            n = (sign / size) * n;
            const double way = dot(n, of_a.from - of_b.from);
            const double of_normal = error * product / size * reach_;
            least_ = std::min(least_, way - of_normal);
            if (least >= -slack && most <= slack) least_ = std::min(least_, -way - of_normal);
            if (sign > 0 ? most < -slack : least > slack) {
                add({n, way, WayKind::edges, of_a.place, of_b.place});
            }
        }
    }
}

}  // namespace cdprep
