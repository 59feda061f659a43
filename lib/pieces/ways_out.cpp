// SPDX-License-Identifier: MIT
#include "pieces/ways_out.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "core/numbers.h"
#include "exact/box3.h"
#include "kernels/kernels.h"

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
        std::array<unsigned, PieceShape::kMostCorners> sides;
        for (std::size_t i = 0; i < corners.size(); ++i) sides[i] = far_sides(corners[i], box, far);
        for (std::size_t i = 0; i < shape.edges().size(); ++i) {
            const PieceShape::Edge& edge = shape.edges()[i];
            if ((sides[edge.from] & sides[edge.to]) != 0) continue;
            const Double3& from = corners[edge.from];
            const Double3 along = corners[edge.to] - from;
            edge_[count_++] = {from,
                               along,
                               corners[edge.left] - from,
                               corners[edge.right] - from,
                               length(along),
                               static_cast<std::uint8_t>(i)};
            shortest_ = std::min(shortest_, edge_[count_ - 1].length);
        }
        error_ = std::max(0.0, 2 * shape.position_error() / shortest_) + 4 * kUnit;  // 0 / 0 is 0
    }
    [[nodiscard]] std::span<const NearEdge> all() const noexcept {
        return std::span(edge_).first(count_);
    }
    /// Returns the length of the shortest, or infinity.
    [[nodiscard]] double shortest() const noexcept {
        return shortest_;
    }
    /// Returns the largest error of the direction of an edge, relative.
    [[nodiscard]] double error() const noexcept {
        return error_;
    }

private:
    /// Returns the sides of a box beyond which a point is farther than `far` along an axis.
    static unsigned far_sides(const Double3& p, const Box3& box, double far) noexcept {
        const auto side = [far](double gap, unsigned bit) { return gap > far ? 1U << bit : 0U; };
        return side(box.lower.x - p.x, 0) | side(p.x - box.upper.x, 1) |
               side(box.lower.y - p.y, 2) | side(p.y - box.upper.y, 3) |
               side(box.lower.z - p.z, 4) | side(p.z - box.upper.z, 5);
    }

    std::size_t count_ = 0;
    double shortest_ = kInfinity;
    double error_;
    std::array<NearEdge, PieceShape::kMostEdges> edge_;
};

/// The same edges by lanes, to find those of interest for one edge of the other piece.
class EdgesByLanes {
public:
    explicit EdgesByLanes(std::span<const NearEdge> edges) noexcept : count_(edges.size()) {
        for (std::size_t i = 0; i < count_; ++i) put(i, edges[i]);
        const std::size_t lanes = kernels::kLanes * blocks();
        for (std::size_t i = count_; i < lanes; ++i) put(i, edges[count_ - 1]);
    }
    /// Calls visit(i) for each edge that kernels::Table::edges_across() leaves.
    template <class Visit>
    void each_across(const NearEdge& edge, double error_of_height, Visit&& visit) const noexcept {
        const kernels::OneEdge one = {{edge.along.x, edge.along.y, edge.along.z},
                                      {edge.left.x, edge.left.y, edge.left.z},
                                      {edge.right.x, edge.right.y, edge.right.z},
                                      edge.length};
        std::array<std::uint8_t, kMostBlocks> across;
        kernels::active().edges_across(block_.data(), blocks(), one, error_of_height,
                                       across.data());
        for (std::size_t block = 0; block < blocks(); ++block) {
            for (unsigned rest = across[block]; rest != 0; rest &= rest - 1) {
                const std::size_t i =
                    kernels::kLanes * block + static_cast<std::size_t>(std::countr_zero(rest));
                if (i < count_) visit(i);
            }
        }
    }

private:
    static constexpr std::size_t kMostBlocks = PieceShape::kMostEdges / kernels::kLanes;
    static_assert(PieceShape::kMostEdges % kernels::kLanes == 0);

    [[nodiscard]] std::size_t blocks() const noexcept {
        return (count_ + kernels::kLanes - 1) / kernels::kLanes;
    }
    void put(std::size_t i, const NearEdge& edge) noexcept {
        kernels::EdgeLanes& block = block_[i / kernels::kLanes];
        const std::size_t lane = i % kernels::kLanes;
        const auto store = [lane](double(&rows)[3][kernels::kLanes], const Double3& vector) {
            rows[0][lane] = vector.x;
            rows[1][lane] = vector.y;
            rows[2][lane] = vector.z;
        };
        store(block.along, edge.along);
        store(block.left, edge.left);
        store(block.right, edge.right);
        block.length[lane] = edge.length;
    }

    std::size_t count_;
    std::array<kernels::EdgeLanes, kMostBlocks> block_;
};

/// The reach of one hull behind each face of another.
class WaysThrough {
public:
    WaysThrough(const PieceShape& of, const PieceShape& other) noexcept : of_(of) {
        kernels::active().reaches(of.inward()[0].at[0].data(), of.inward().size(),
                                  &other.corners()[0].x, other.corners().size(), reach_.data());
    }
    /// Returns the way through the face with a number.
    [[nodiscard]] double of_face(std::size_t i) const noexcept {
        const PieceShape::Face& face = of_.faces()[i];
        return dot(face.normal, of_.corners()[face.corner]) + reach_[i];
    }

private:
    const PieceShape& of_;
    static_assert(PieceShape::kMostFaces % kernels::kLanes == 0);
    std::array<double, PieceShape::kMostFaces> reach_;
};

}  // namespace

double shortest_way_by_faces(const PieceShape& a, const PieceShape& b) noexcept {
    const double reach = a.reach() + b.reach();
    double shortest = kInfinity;
    const auto look = [&](const PieceShape& of, const PieceShape& other) {
        const WaysThrough ways(of, other);
        for (std::size_t i = 0; i < of.faces().size(); ++i) {
            shortest = std::min(shortest, ways.of_face(i) + of.faces()[i].error * reach);
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
    clear();
    skipped_angle_ = 0;
    least_ = shortest_of_faces_ = kInfinity;
    position_error_ = a.position_error() + b.position_error();
    reach_ = a.reach() + b.reach();
    add_faces(a, b, WayKind::face_a);
    add_faces(b, a, WayKind::face_b);
    const double far =
        they_meet ? kFar * std::max(0.0, shortest_of_faces_) + kTie * reach_ : kInfinity;
    if (!add_edges(a, b, far)) return false;
    least_ -= position_error_ + (2 * skipped_angle_ + 16 * kUnit) * reach_;
    return true;
}

void WaysOut::add(const WayOut& way) noexcept {
    assert(found_ == 0);
    if (count_ == kRoom) keep_shortest();
    const double order = way.length + (way.kind == WayKind::edges ? kTie * reach_ : 0);
    way_[count_] = way;
    // NaN has no order. Infinity is that of a way in place_.
    constexpr double kLongest = std::numeric_limits<double>::max();
    order_[count_++] = order < kLongest ? order : kLongest;
}

/// Keeps the kMost shortest ways, in the order in which they came.
void WaysOut::keep_shortest() noexcept {
    std::array<double, kRoom> sorted = order_;
    std::nth_element(sorted.begin(), sorted.begin() + (kMost - 1), sorted.end());
    const double longest = sorted[kMost - 1];
    auto as_long =
        static_cast<std::size_t>(std::count(sorted.begin(), sorted.begin() + kMost, longest));
    count_ = 0;
    for (std::size_t i = 0; i < kRoom; ++i) {
        if (order_[i] > longest || (order_[i] == longest && as_long == 0)) continue;
        if (order_[i] == longest) --as_long;
        way_[count_] = way_[i];
        order_[count_++] = order_[i];
    }
}

/// Of ways that are equally long, the first one counts.
void WaysOut::find_next() noexcept {
    const auto all = std::span(order_).first(count_);
    const auto next = std::min_element(all.begin(), all.end());
    place_[found_++] = static_cast<std::uint8_t>(next - all.begin());
    *next = kInfinity;
}

/// Adds the normals of the faces of one hull.
void WaysOut::add_faces(const PieceShape& of, const PieceShape& other, WayKind kind) noexcept {
    const WaysThrough ways(of, other);
    for (std::size_t i = 0; i < of.faces().size(); ++i) {
        const PieceShape::Face& face = of.faces()[i];
        const double way = ways.of_face(i);
        least_ = std::min(least_, way - face.error * reach_);
        shortest_of_faces_ = std::min(shortest_of_faces_, way);
        const auto place = static_cast<std::uint8_t>(i);
        add({kind == WayKind::face_a ? face.normal : -face.normal, way, kind, place, place});
    }
}

/// Adds the directions across two edges along which each is the end of its hull. One next to the
/// normal of a face, up to rounding, counts for the bound alone. Edges farther apart than `far` are
/// left out. Returns false if an edge is too short.
bool WaysOut::add_edges(const PieceShape& a, const PieceShape& b, double far) noexcept {
    const NearEdges near_a(a, b.box(), far), near_b(b, a.box(), far);
    if (!(std::min(near_a.shortest(), near_b.shortest()) > PieceShape::kShortest)) return false;
    const EdgesByLanes lanes_b(near_b.all());
    const double error = near_a.error() + near_b.error() + 8 * kUnit;
    const double error_of_height = 4 * (error * reach_ + position_error_);
    for (const NearEdge& of_a : near_a.all()) {
        // Most pairs are left out here: one corner is above the plane of both edges, another below.
        lanes_b.each_across(of_a, error_of_height, [&](std::size_t i) {
            const NearEdge& of_b = near_b.all()[i];
            Double3 n = cross(of_a.along, of_b.along);
            const double size = length(n);
            const double product = of_a.length * of_b.length;
            const double angle = size / product + error;
            if (2 * angle * size <= error * product) {
                skipped_angle_ = std::max(skipped_angle_, angle);
                return;
            }
            const double slack = product * error_of_height;
            const double left = dot(n, of_a.left), right = dot(n, of_a.right);
            const double other_left = -dot(n, of_b.left), other_right = -dot(n, of_b.right);
            const double most = std::max({left, right, other_left, other_right});
            const double least = std::min({left, right, other_left, other_right});
            const double sign = most <= slack ? 1 : -1;
            n = (sign / size) * n;
            const double way = dot(n, of_a.from - of_b.from);
            const double of_normal = error * product / size * reach_;
            least_ = std::min(least_, way - of_normal);
            if (least >= -slack && most <= slack) least_ = std::min(least_, -way - of_normal);
            if (sign > 0 ? most < -slack : least > slack) {
                add({n, way, WayKind::edges, of_a.place, of_b.place});
            }
        });
    }
    return true;
}

}  // namespace cdprep
