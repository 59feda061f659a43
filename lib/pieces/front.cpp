// SPDX-License-Identifier: MIT
#include "pieces/front.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "hull/nearest_simplex.h"

// Rounding. Let v = 2^-24, s_a and s_b the scales, t the shift. When a plane is set, the reach of a
// box or a swept sphere is off by at most 20 v of its scale. The reach of a leaf is computed in
// float and is off by less. Hulls and middles are computed in double. The direction along B's axes
// is off by v in each component, which moves B's reach by 2 v s_b. Moving a plane adds
// 64 v (s_a + s_b + |t|) (weak_planes.h). In all that is below 96 v (s_a + s_b + |t|): three times
// BoxPlacement's slack. That slack also covers vertices that are off their ideal places.

namespace cdprep {
namespace {

/// A front is restarted when it has more than twice the pairs of its beginning plus this number.
constexpr std::uint32_t kMoreBeforeAnew = 64;
/// A front that is lost stays unused for 2^0 - 1 queries, after the next loss for 2^1 - 1, up to
/// 2^this - 1.
constexpr std::uint32_t kMostFailures = 6;
/// The slack of planes, as a multiple of BoxPlacement::slack.
constexpr double kSlack = 3;
/// The tolerance of a search for a farthest point, as a share of the size of its place.
constexpr double kTolerance = 0x1p-6;
/// A length that no rounding brings above 1.
constexpr double kShort = 1 - 0x1p-20;

Direction floats(const Double3& d) noexcept {
    return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
}

Double3 rounded(const Double3& d) noexcept {
    const Direction f = floats(d);
    return {f[0], f[1], f[2]};
}

/// Returns a float that is not below x, which may be any number.
float above(double x) noexcept {
    return static_cast<float>(x + 0x1p-22 * std::fabs(x));
}

}  // namespace

bool is_of(const PairFront& front, const Model& a, const Model& b) noexcept {
    return front.count > 0 && front.models[0] == a.header().content_hash &&
           front.models[1] == b.header().content_hash;
}

bool is_time_to_begin(PairFront& front) noexcept {
    if (front.wait == 0) return true;
    --front.wait;
    return false;
}

Front::Front(PairFront& kept, const Model& a, const Model& b, const PlacedBoxes& placed,
             const LeafBatch& leaves, const PieceTrees& trees, Workspace::Storage& scratch,
             const float* way) noexcept
    : kept_(kept),
      placed_(placed),
      leaves_(leaves),
      trees_(trees),
      scratch_(scratch),
      models_{a.header().content_hash, b.header().content_hash},
      a_{trees.a, leaves.placement().a, placed.scale_a, a.pieces().node_hulls, a.header()},
      b_{trees.b, leaves.placement().b, placed.scale_b, b.pieces().node_hulls, b.header()},
      way_(way),
      slack_(kSlack * double{placed.placement.slack}) {}

Double3 Front::turned_to_b(const Double3& d) const noexcept {
    const std::array<double, 9>& r = placed_.rotation;
    return {r[0] * d.x + r[3] * d.y + r[6] * d.z, r[1] * d.x + r[4] * d.y + r[7] * d.z,
            r[2] * d.x + r[5] * d.y + r[8] * d.z};
}

Double3 Front::moved_to_a(const Double3& p) const noexcept {
    const std::array<double, 9>& r = placed_.rotation;
    const std::array<double, 3>& t = placed_.shift;
    return {r[0] * p.x + r[1] * p.y + r[2] * p.z + t[0],
            r[3] * p.x + r[4] * p.y + r[5] * p.z + t[1],
            r[6] * p.x + r[7] * p.y + r[8] * p.z + t[2]};
}

Reached Front::farthest_of_a(const TreePlace& place, const Double3& d) const noexcept {
    const auto each_view = [&](std::uint32_t leaf, auto&& test) {
        trees_.each_view_a(leaves_, leaf, test);
    };
    const double size = box_size(a_.tree, place, placed_.placement.scale_a);
    return farthest_below(a_, place, floats(d), each_view, kTolerance * size);
}

Reached Front::farthest_of_b(const TreePlace& place, const Double3& d) const noexcept {
    const auto each_view = [&](std::uint32_t leaf, auto&& test) {
        trees_.each_view_b(leaves_, leaf, test);
    };
    const double size = box_size(b_.tree, place, placed_.placement.scale_b);
    return farthest_below(b_, place, floats(d), each_view, kTolerance * size);
}

void Front::set_gap(Plane& plane) const noexcept {
    const Double3 shift = {placed_.shift[0], placed_.shift[1], placed_.shift[2]};
    plane.gap = dot(plane.direction, shift) - plane.of_a.far - plane.of_b.far - slack_;
}

Front::Plane Front::plane_across(const PendingPair& pair, const Double3& d) const noexcept {
    Plane plane;
    plane.direction = rounded(d);
    plane.turned = rounded(turned_to_b(plane.direction));
    plane.of_a = farthest_of_a(pair.a, plane.direction);
    plane.of_b = farthest_of_b(pair.b, -plane.turned);
    set_gap(plane);
    return plane;
}

/// Returns a stored plane as it is in this pose. Along A's axes nothing has moved.
Front::Plane Front::plane_again(std::uint32_t number, const PendingPair& pair) const noexcept {
    Plane plane;
    plane.direction = {at(along, number), at(along + 1, number), at(along + 2, number)};
    plane.turned = rounded(turned_to_b(plane.direction));
    plane.of_a.far = at(far_a, number);
    plane.of_b = farthest_of_b(pair.b, -plane.turned);
    set_gap(plane);
    return plane;
}

Front::Ball Front::ball_around_b(const TreePlace& place) const noexcept {
    const format::BvhShape& shape = b_.tree.shape;
    if (place.height == shape.levels) return {{}, std::sqrt(3.0) * b_.scale};
    const format::BvhNode& node =
        b_.tree.nodes[shape.first[place.height] + place.index / format::kBvhWidth];
    const std::size_t box = place.index % format::kBvhWidth;
    std::array<double, 3> middle{};
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lower = b_.scale * double{node.lower[axis][box]};
        const double upper = b_.scale * double{node.upper[axis][box]};
        // The reach is measured from the middle as it will be stored.
        middle[axis] = double{static_cast<float>((lower + upper) / 2)};
        const double half = std::max(upper - middle[axis], middle[axis] - lower);
        squared += half * half;
    }
    return {{middle[0], middle[1], middle[2]}, std::sqrt(squared)};
}

void Front::store(std::uint32_t number, const PendingPair& pair,
                  const Plane& plane) const noexcept {
    assert(number < kFrontRoom);
    const auto set = [&](std::size_t row, const Double3& from) {
        const Direction f = floats(from);
        for (std::size_t i = 0; i < 3; ++i) at(row + i, number) = f[i];
    };
    const Ball ball = ball_around_b(pair.b);
    kept_.pair[number] = pair.packed();
    set(along, plane.direction);
    set(along_b, plane.turned);
    set(middle_b, ball.middle);
    at(reach_b, number) = above(ball.reach);
    at(far_a, number) = above(plane.of_a.far);
    at(gap_at, number) = -above(double{at(far_a, number)} + plane.of_b.far);
}

void Front::begin() noexcept {
    kept_.models = models_;
    kept_.count = 1;
    kept_.begun_with = 0;
    const std::array<double, 3>& t = placed_.shift;
    const double length = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    const double scale = length > 0 ? kShort / length : 0;
    Plane plane;
    plane.direction = rounded({scale * t[0], scale * t[1], scale * t[2]});
    if (!(scale > 0)) plane.direction = {1, 0, 0};
    plane.turned = rounded(turned_to_b(plane.direction));
    // It proves nothing yet.
    plane.of_a.far = std::numeric_limits<float>::infinity();
    plane.of_b.far = 0;
    store(0, roots(trees_.a, trees_.b), plane);
}

std::size_t Front::find_weak(float limit) noexcept {
    assert(kept_.count > 0 && kept_.count <= kFrontRoom);
    const bool has_grown =
        kept_.begun_with > 0 && kept_.count > 2 * kept_.begun_with + kMoreBeforeAnew;
    if (has_grown) begin();
    return kernels::active().weak_planes(placed_.placement, {kept_.row[0].data(), kFrontRoom},
                                         kept_.count, limit, scratch_.weak_planes.data());
}

void Front::lose() noexcept {
    kept_.count = 0;
    kept_.wait = (1U << std::min(kept_.failures, kMostFailures)) - 1;
    kept_.failures = std::min(kept_.failures + 1, kMostFailures);
}

/// Returns the stored plane if it is strong enough in this pose, otherwise a better one if there is
/// one. For two leaves, the only other candidate is the plane across the way between the nearest
/// points so far. Testing their triangles takes less time than a search.
Front::Plane Front::part(std::uint32_t number, const PendingPair& pair,
                         float limit) const noexcept {
    const Plane again = plane_again(number, pair);
    if (again.gap > double{limit}) return again;
    if (!is_down_at(pair.packed(), 0)) return search(pair, again, limit);
    const Double3 way = {way_[0], way_[1], way_[2]};
    if (!(dot(way, way) > 0)) return again;
    const Plane across_way = plane_across(pair, way);
    return across_way.gap > again.gap ? across_way : again;
}

/// Searches for the nearest points by the algorithm of Gilbert, Johnson and Keerthi. Ends with the
/// first plane that is strong enough, or when there is none.
Front::Plane Front::search(const PendingPair& pair, const Plane& from, float limit) const noexcept {
    constexpr int kMostSteps = 8;  // limits the time: the best plane so far proves less, but holds
    NearestSimplex simplex;
    Plane best = from;
    Plane plane = from;
    plane.of_a = farthest_of_a(pair.a, plane.direction);  // its point is not stored
    for (int step = 0; step < kMostSteps; ++step) {
        const Double3 apart = plane.of_a.at - moved_to_a(plane.of_b.at);
        const auto is_known = [&](const Difference& corner) { return corner.at == apart; };
        const Difference* first = simplex.corner.data();
        if (std::any_of(first, first + simplex.count, is_known)) break;
        simplex.corner[simplex.count++].at = apart;
        keep_nearest(simplex);
        if (simplex.count == 4) break;
        const Double3 way = weighted_point(simplex);
        const double length = std::sqrt(dot(way, way));
        if (!(length > double{limit} + slack_)) break;
        plane = plane_across(pair, (-kShort / length) * way);
        if (plane.gap > best.gap) best = plane;
        if (best.gap > double{limit}) break;
    }
    return best;
}

bool Front::split(std::uint32_t number, const PendingPair& pair, const Plane& plane, float limit,
                  std::size_t& waiting) noexcept {
    const kernels::BoxPlacement& p = placed_.placement;
    const bool goes_down_a =
        pair.b.height == 0 || (pair.a.height > 0 && !(box_size(a_.tree, pair.a, p.scale_a) <
                                                      box_size(b_.tree, pair.b, p.scale_b)));
    const TestedBoxes boxes =
        goes_down_a ? boxes_of(a_.tree, pair.a, true) : boxes_of(b_.tree, pair.b, true);
    if (kept_.count + boxes.last - 1 > kFrontRoom) return false;
    for (std::uint32_t box = 0; box < boxes.last; ++box) {
        const TreePlace below = {boxes.first_below.height, boxes.first_below.index + box};
        PendingPair child = pair;
        Plane of_child = plane;
        if (goes_down_a) {
            child.a = below;
            of_child.of_a = farthest_of_a(below, plane.direction);
        } else {
            child.b = below;
            of_child.of_b = farthest_of_b(below, -plane.turned);
        }
        set_gap(of_child);
        const std::uint32_t to = box == 0 ? number : kept_.count++;
        store(to, child, of_child);
        if (of_child.gap > double{limit}) continue;
        assert(waiting < scratch_.weak_planes.size());
        scratch_.weak_planes[waiting++] = static_cast<std::uint16_t>(to);
    }
    return true;
}

}  // namespace cdprep
