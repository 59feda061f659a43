// SPDX-License-Identifier: MIT
#include "pieces/contact_steps.h"

#include <algorithm>
#include <cmath>

#include "hull/hull_edges.h"
#include "pieces/choose_four.h"

namespace cdprep {
namespace {

constexpr std::size_t kMostOutline = 64;  ///< corners kept of a face: limits time and stack
/// The cosine above which a face counts as perpendicular to the contact normal. Rounding turns
/// neither that far.
constexpr double kAcross = 1 - 1e-10;
/// The cosine, of 0.03 radians, above which a face has manifold points although the normal is not
/// its own. Two faces that are nearly parallel may be nearest where their edges cross. The normal
/// is then across the edges. Bodies that rest on one point there would tip.
constexpr double kNearlyAcross = 0.99955;

/// A difference of two cosines: some thousand times what rounding may add. A face of the hull is
/// preferred to the triangle that is a part of it.
constexpr double kWholeFace = 1e-12;
/// A point is behind the base if it is so far behind, as a share of its distance from a corner
/// there. kAcross lets the base lean by less.
constexpr double kBehind = 2e-5;
/// The part of that for the rounding of moved corners, as a share of their coordinates.
constexpr double kMovedBehind = 0x1p-45;
/// As a share of a distance: two ways to compute it may differ by so much. If they differ by more,
/// the contact only gets one more candidate.
constexpr double kSameDistance = 1e-9;

/// A corner of a polygon.
struct Corner {
    Double3 at;
    std::uint64_t id;    ///< of the vertex, or of the two sides that cross there
    std::uint64_t side;  ///< of the side to the next corner
};

/// Corners of a convex polygon, counter-clockwise as seen from the tip of `normal`. It is filled in
/// place. A copy of its room takes longer than what is done with few corners.
struct Polygon {
    std::array<Corner, 2 * kMostOutline> corner;
    std::size_t count = 0;
    Double3 normal{};

    void add(const Corner& c) noexcept {
        if (count < corner.size()) corner[count++] = c;
    }
    [[nodiscard]] const Corner& next(std::size_t i) const noexcept {
        return corner[(i + 1) % count];
    }
    /// Numbers the sides by their ends, whichever comes first.
    void name_sides() noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint64_t p = corner[i].id, q = next(i).id;
            corner[i].side = mixed_ids(std::min(p, q), std::max(p, q));
        }
    }
};

/// Puts the corners of a triangle into an empty polygon. `normal` is its front or its back.
void add_triangle(const ContactSide& side, std::uint32_t triangle, const Corners& t,
                  const Double3& normal, Polygon& polygon) {
    const auto& vertex = side.model().model->mesh().triangles[triangle].vertex;
    for (std::size_t k = 0; k < 3; ++k) polygon.add({t[k], side.source_vertex(vertex[k]), 0});
    if (dot(unit_normal(t), normal) < 0) std::swap(polygon.corner[1], polygon.corner[2]);
    polygon.normal = normal;
    polygon.name_sides();
}

/// Puts the corners of a face into an empty polygon. If they are too many, it takes an even
/// selection of them: a part of the face. `normal` is its front or its back.
void add_face(const ContactSide& side, std::uint32_t first, const Double3& normal,
              Polygon& polygon) {
    const HullEdges edges(side.facets(), side.adjacency());
    std::size_t all = 0;
    edges.each_around_face(first, [&](const FacetPlace&) { ++all; });
    polygon.normal = normal;
    const std::size_t kept = std::min(all, kMostOutline);
    std::size_t i = 0;
    edges.each_around_face(first, [&](const FacetPlace& p) {
        if (i == 0 || i * kept / all != (i - 1) * kept / all) {
            const std::uint32_t corner = edges.start(p);
            polygon.add(
                {side.corner(corner), side.source_vertex(side.points().corners[corner]), 0});
        }
        ++i;
    });
    const auto& c = side.facets()[first].corner;
    const Corners front = {side.corner(c[0]), side.corner(c[1]), side.corner(c[2])};
    if (dot(unit_normal(front), normal) < 0) {
        std::reverse(polygon.corner.begin(),
                     polygon.corner.begin() + static_cast<std::ptrdiff_t>(polygon.count));
    }
    polygon.name_sides();
}

/// Puts the face that faces a direction most into an empty polygon. It is a face of the hull if
/// triangles cover it, otherwise the feature's own triangle.
void add_facing(const ContactSide& side, const PieceFeature& feature, const Double3& direction,
                Polygon& polygon) {
    const Corners own = side.model().corners(feature.triangle);
    Double3 own_normal = unit_normal(own);
    if (dot(own_normal, direction) < 0) own_normal = -own_normal;
    std::optional<std::uint32_t> best;
    double most = dot(own_normal, direction) - kWholeFace;
    Double3 normal{};
    const auto facets = side.facets();
    std::array<float, PlacedHull::kMostFacets> room;
    const std::span<const float> cosines = side.face_cosines(direction, room);
    // A surface that bounds no solid can be met from either side.
    const auto facing = [&](auto cosine) {
        return side.is_contained() ? cosine : std::fabs(cosine);
    };
    float least = -2;
    for (const float cosine : cosines) least = std::max(least, facing(cosine));
    least -= 2 * ContactSide::kCosineError;
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
        if (!cosines.empty() && facing(cosines[f]) < least) continue;
        if (facets[f].flags != format::facet_first_of_face) continue;
        const auto& c = facets[f].corner;
        const Corners corners = {side.corner(c[0]), side.corner(c[1]), side.corner(c[2])};
        if (most > 0 && is_surely_turned(corners, direction, most)) continue;
        const Double3 n = unit_normal(corners);
        const double along = dot(n, direction), faces = facing(along);
        if (faces > most) most = faces, best = f, normal = along < 0 ? -n : n;
    }
    if (best) add_face(side, *best, normal, polygon);
    if (polygon.count >= 3) return;  // flags of a damaged file may leave no outline
    polygon.count = 0;
    add_triangle(side, feature.triangle, own, own_normal, polygon);
}

/// Puts the part of a polygon where dot(inward, p - on) >= 0 into an empty one. The new side has
/// the number `side`.
void add_clipped(const Polygon& polygon, const Double3& on, const Double3& inward,
                 std::uint64_t side, Polygon& part) {
    part.normal = polygon.normal;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Corner &p = polygon.corner[i], &q = polygon.next(i);
        const double at_p = dot(inward, p.at - on), at_q = dot(inward, q.at - on);
        const bool leaves = at_p >= 0 && at_q < 0;
        // Where the polygon leaves at a corner, the new side begins there.
        if (at_p >= 0) part.add({p.at, p.id, leaves && at_p == 0 ? side : p.side});
        if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
            const Double3 cut = p.at + at_p / (at_p - at_q) * (q.at - p.at);
            part.add({cut, mixed_ids(p.side, side), leaves ? side : p.side});
        }
    }
}

/// Returns a direction, with the length 1 if its products with other lengths may leave the range of
/// double.
Double3 in_range(const Double3& direction) {
    constexpr double kLeast = 0x1p-100, kMost = 0x1p100;
    const double size = largest_of(direction);
    return size > kLeast && size < kMost ? direction : unit(direction);
}

/// Returns the part of a polygon that is over another one, seen along a direction near the other's
/// normal. It is the polygon itself, or in `room`.
const Polygon& over(const Polygon& base, const Polygon& polygon, const Double3& way,
                    std::array<Polygon, 2>& room) {
    const Polygon* part = &polygon;
    for (std::size_t i = 0; i < base.count && part->count > 0; ++i) {
        const Corner& p = base.corner[i];
        Polygon& next = room[i % 2];
        next.count = 0;
        add_clipped(*part, p.at, cross(way, in_range(base.next(i).at - p.at)), p.side, next);
        part = &next;
    }
    return *part;
}

/// Returns whether a point at a height over a base is behind it.
bool is_behind(double height, const Double3& at, const Double3& base) {
    return height < -(kBehind * largest_of(at - base) + kMovedBehind * largest_of(at));
}

/// Points of a contact before the choice of four.
class Candidates {
public:
    void add(const ManifoldPoint& point) noexcept {
        if (count_ < point_.size()) point_[count_++] = point;
    }
    /// Returns whether one is at a distance, or nearer, up to rounding.
    [[nodiscard]] bool reach(double distance) const noexcept {
        return std::any_of(point_.begin(), point_.begin() + static_cast<std::ptrdiff_t>(count_),
                           [&](const ManifoldPoint& p) {
                               return p.distance <= distance + kSameDistance * std::fabs(distance);
                           });
    }
    [[nodiscard]] std::span<const ManifoldPoint> all() const noexcept {
        return std::span(point_).first(count_);
    }

private:
    std::array<ManifoldPoint, 2 * kMostOutline> point_;
    std::size_t count_ = 0;
};

}  // namespace

void add_manifold(const ContactSide& a, const ContactSide& b, const PieceFeature& feature_a,
                  const PieceFeature& feature_b, double tolerance, Contact& contact) noexcept {
    const Double3 n = contact.normal;
    Polygon of_a, of_b;
    add_facing(a, feature_a, n, of_a);
    add_facing(b, feature_b, -n, of_b);
    const double across_a = dot(of_a.normal, n), across_b = -dot(of_b.normal, n);
    Candidates candidates;
    const bool a_is_base = across_a >= across_b;
    const double across = std::max(across_a, across_b);
    if (across >= kNearlyAcross) {
        const Polygon& base = a_is_base ? of_a : of_b;
        // Along the contact's normal, so that no point of an overlap is deeper than the contact.
        const bool leans = across < kAcross;
        const Double3 way = !leans ? base.normal : a_is_base ? n : -n;
        const bool overlaps = (contact.flags & contact_overlap) != 0;
        std::array<Polygon, 2> room;
        const Polygon& part = over(base, a_is_base ? of_b : of_a, way, room);
        for (std::size_t i = 0; i < part.count; ++i) {
            const Corner& p = part.corner[i];
            double height = dot(base.normal, p.at - base.corner[0].at);
            if (leans) height /= across;
            const Double3 foot = p.at - height * way;
            if (height > tolerance) continue;
            // The normal need not separate the hulls of pieces that do not overlap.
            if (!overlaps && height < 0 && is_behind(height, p.at, base.corner[0].at)) continue;
            candidates.add(a_is_base ? ManifoldPoint{foot, p.at, height, p.id}
                                     : ManifoldPoint{p.at, foot, height, p.id});
        }
    }
    if (!candidates.reach(contact.lower)) candidates.add(only_point(contact));
    choose_four(candidates.all(), contact);
}

}  // namespace cdprep
