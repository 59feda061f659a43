// SPDX-License-Identifier: MIT
#include "pieces/deep_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cdprep/format/limits.h"
#include "cdprep/hulls.h"
#include "core/numbers.h"
#include "hull/moved_hull.h"
#include "pieces/contact_side.h"
#include "walk/nearest_triangle.h"

// No triangles of the two models touch, so the contact cannot come from pieces. The way out
// leads out of hulls that enclose the other model. A direction is tried as follows: B moves until a
// plane separates it from a hull that it overlaps, and again, until it overlaps none. Each hull
// moves B once at most. If the hulls are parts, the component could then be in a space between
// them, inside the solid: its vertex is tested.

namespace cdprep {
namespace {

using format::HullScope;

/// The most hulls whose shortest ways out are tried. It limits the time: each way is tested against
/// all parts, as often as it leads into another one.
constexpr std::size_t kMostDirections = 32;

/// The corners of a box as a hull.
class BoxHull {
public:
    explicit BoxHull(const Box3& box) noexcept {
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            corners_[i] = {(i & 1) != 0 ? box.upper.x : box.lower.x,
                           (i & 2) != 0 ? box.upper.y : box.lower.y,
                           (i & 4) != 0 ? box.upper.z : box.lower.z};
        }
    }
    [[nodiscard]] ConvexPoints points() const noexcept {
        ConvexPoints points;
        points.count = static_cast<std::uint32_t>(corners_.size());
        const Double3 &lower = corners_.front(), &upper = corners_.back();
        points.reach = {std::max(std::fabs(lower.x), std::fabs(upper.x)),
                        std::max(std::fabs(lower.y), std::fabs(upper.y)),
                        std::max(std::fabs(lower.z), std::fabs(upper.z))};
        points.corners = kNumbers;
        points.doubles = corners_;
        return points;
    }

private:
    static constexpr std::array<std::uint32_t, 8> kNumbers = {0, 1, 2, 3, 4, 5, 6, 7};
    std::array<Double3, 8> corners_;
};

/// Hulls that enclose a model or one component of it.
class EnclosingHulls {
public:
    EnclosingHulls(const Model& model, std::optional<std::uint32_t> component) noexcept
        : model_(&model), box_(box_around(MovedModel(model, nullptr))) {
        if (!model.serves(Ask::hulls)) return;
        std::optional<std::uint32_t> found;
        if (component) {
            found = find_hull(model, HullScope::component, *component);
        } else {
            found = find_hull(model, HullScope::part);
            if (found) parts_ = static_cast<std::uint32_t>(model.hulls().hulls.size()) - *found;
        }
        first_ = found ? found : find_hull(model, HullScope::whole);
    }

    [[nodiscard]] std::uint32_t count() const noexcept {
        return std::max(parts_, 1U);
    }
    [[nodiscard]] ConvexPoints points(std::uint32_t i) const noexcept {
        return first_ ? convex_points(*model_, *first_ + i) : box_.points();
    }
    [[nodiscard]] bool has_parts() const noexcept {
        return parts_ > 0;
    }
    /// Returns the hull of the whole beside its parts.
    [[nodiscard]] std::optional<ConvexPoints> whole() const noexcept {
        const auto found = has_parts() ? find_hull(*model_, HullScope::whole) : std::nullopt;
        return found ? std::optional(convex_points(*model_, *found)) : std::nullopt;
    }
    /// Forgets the parts: one hull remains.
    void take_whole() noexcept {
        parts_ = 0;
        first_ = find_hull(*model_, HullScope::whole);
    }

private:
    const Model* model_;
    BoxHull box_;
    std::optional<std::uint32_t> first_;  ///< in the file; none: the box
    std::uint32_t parts_ = 0;
};

/// A translation of B that separates it from A.
struct DeepWay {
    Double3 normal{};  ///< of length 1 up to rounding
    double length = kInfinity;
};

/// The ways in which B leaves A, where a component of one is inside the other.
class DeepWays {
public:
    DeepWays(const Pair& pair, const Enclosed& enclosed, Workspace::Storage& scratch) noexcept
        : placement_(pair.placement),
          is_of_a_(enclosed.is_of_a),
          outer_(is_of_a_ ? moved_b(pair.b, placement_) : moved_a(pair.a, placement_)),
          inner_(is_of_a_ ? moved_a(pair.a, placement_) : moved_b(pair.b, placement_)),
          vertex_(inner_.position(inner_.model->record().components[enclosed.component].vertex)),
          outer_hulls_(*outer_.model, std::nullopt),
          inner_hulls_(*inner_.model, enclosed.component),
          scratch_(scratch) {}

    [[nodiscard]] DeepWay shortest() noexcept {
        DeepWay best = shortest_of_normals();
        if (outer_hulls_.has_parts() && !std::isfinite(best.length)) {
            outer_hulls_.take_whole();
            best = shortest_of_normals();
        }
        if (std::isfinite(best.length)) return best;
        // At the end of the range of double: a plane across x separates all the same.
        constexpr Double3 kAcross = {1, 0, 0};
        return {kAcross, length_along(kAcross, 0)};
    }
    /// Returns the point of the inner hull that is last to leave.
    [[nodiscard]] Double3 last_point(const Double3& normal) const noexcept {
        const ConvexPoints inner = inner_hulls_.points(0);
        const MovedHull hull(inner, inner_.pose);
        return hull.point(hull.farthest_anew(is_of_a_ ? normal : -normal, 0));
    }
    [[nodiscard]] const Double3& vertex() const noexcept {
        return vertex_;
    }
    [[nodiscard]] const MovedModel& outer() const noexcept {
        return outer_;
    }
    [[nodiscard]] const MovedModel& inner() const noexcept {
        return inner_;
    }

private:
    /// Returns the placement after B has moved by `way`: A moves back where B does not move.
    [[nodiscard]] std::optional<Placement> after(const Double3& way) const noexcept {
        const auto shifted = [](const Pose& pose, const Double3& by) {
            const std::array<double, 9>& r = pose.rotation();
            const Double3 t = pose.translation() + by;
            return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8],  //
                                    t.x, t.y, t.z});
        };
        const bool moves_b = placement_.b_is_moved();
        const Pose& before = moves_b ? placement_.pose_b() : placement_.pose_a();
        const Double3 by = moves_b ? way : -way;
        // Out of the range of coordinates: a refused pose would allocate its message.
        if (!(largest_of(before.translation() + by) <= format::kMaxCoordinate)) return std::nullopt;
        const Result<Pose> pose = shifted(before, by);
        if (!pose) return std::nullopt;
        if (!moves_b) return Placement::a_moves(*pose);
        return placement_.a_is_moved() ? Placement::world(placement_.pose_a(), *pose)
                                       : Placement::b_moves(*pose);
    }

    /// Returns the first part that the component overlaps.
    [[nodiscard]] std::optional<std::uint32_t> first_overlap(
        const Placement& placement) const noexcept {
        const ConvexPoints inner = inner_hulls_.points(0);
        for (std::uint32_t i = 0; i < outer_hulls_.count(); ++i) {
            const ConvexPoints outer = outer_hulls_.points(i);
            if (is_of_a_ ? convex_collide(inner, outer, placement)
                         : convex_collide(outer, inner, placement)) {
                return i;
            }
        }
        return std::nullopt;
    }

    /// Returns how far B must move along a unit normal until a plane separates it from a part:
    /// an upper bound, rounding included.
    [[nodiscard]] double length_along(const Double3& normal, std::uint32_t part) const noexcept {
        const ConvexPoints outer_points = outer_hulls_.points(part);
        const ConvexPoints inner_points = inner_hulls_.points(0);
        const MovedHull outer(outer_points, outer_.pose);
        const MovedHull inner(inner_points, inner_.pose);
        const Double3 out = is_of_a_ ? -normal : normal;  // of the outer one
        const std::uint32_t far = outer.farthest_anew(out, 0);
        const Double3 origin = outer.point(far);
        const double sum = outer.proven(out, origin, far).bound +
                           inner.proven(-out, origin, inner.farthest_anew(-out, 0)).bound;
        const double shortest = std::sqrt(dot(normal, normal)) * (1 - 4 * kUnit);
        return std::max(0.0, sum) / shortest * (1 + 8 * kUnit);
    }

    [[nodiscard]] DeepWay shortest_of_normals() const noexcept {
        DeepWay best;
        std::size_t tried = 0;
        if (const auto whole = outer_hulls_.whole()) tried += try_hull(*whole, best) ? 1 : 0;
        for (std::uint32_t i = 0; i < outer_hulls_.count() && tried < kMostDirections; ++i) {
            tried += try_hull(outer_hulls_.points(i), best) ? 1 : 0;
        }
        return best;
    }
    /// Tries the shortest way out of one hull. Returns false if the component is not in it.
    bool try_hull(const ConvexPoints& outer, DeepWay& best) const noexcept {
        const ConvexPoints inner = inner_hulls_.points(0);
        const auto depth = is_of_a_ ? convex_penetration(inner, outer, placement_)
                                    : convex_penetration(outer, inner, placement_);
        if (!depth || !(dot(depth->normal, depth->normal) > 0)) return false;
        try_normal(depth->normal, best);
        return true;
    }
    /// Takes a normal if the way out along it is the shortest so far.
    void try_normal(const Double3& normal, DeepWay& best) const noexcept {
        constexpr double kFirstStep = 0x1p-40;  // of the length: far above its rounding
        double length = 0, farther = kFirstStep;
        for (auto hit = first_overlap(placement_); hit;) {
            const double needed = length_along(normal, *hit);
            // Where rounding keeps them in touch: a little farther, and twice as much each time.
            if (!(needed > length)) farther *= 2;
            length = needed > length ? needed : length * (1 + farther);
            if (!(length < best.length)) return;
            const std::optional<Placement> moved = after(length * normal);
            if (!moved) return;
            hit = first_overlap(*moved);
        }
        const double outwards = is_of_a_ ? -length : length;
        const Inclusion end = inclusion(outer_, vertex_ + outwards * normal, scratch_);
        if (end.answer == Answer::no) best = {normal, length};
    }

    const Placement& placement_;
    bool is_of_a_;
    MovedModel outer_;
    MovedModel inner_;
    Double3 vertex_;  ///< of the component
    EnclosingHulls outer_hulls_;
    EnclosingHulls inner_hulls_;
    Workspace::Storage& scratch_;
};

/// Sets the piece and the feature of one side: those of a triangle.
void put_triangle(const MovedModel& model, std::uint32_t triangle, Workspace::Storage& scratch,
                  std::uint32_t& piece, ContactFeature& feature) noexcept {
    piece = model.model->pieces().of_triangle[triangle];
    feature =
        ContactSide(model, piece, nullptr, scratch).in_source({FeatureKind::face, triangle, 0});
}

}  // namespace

Contact deep_contact(const Pair& pair, const Enclosed& enclosed, Manifold manifold,
                     Workspace::Storage& scratch) noexcept {
    DeepWays ways(pair, enclosed, scratch);
    const DeepWay way = ways.shortest();
    const MovedModel &outer = ways.outer(), &inner = ways.inner();
    const auto wall = nearest_triangle(outer, ways.vertex(), kInfinity, scratch);
    const auto own = nearest_triangle(inner, ways.vertex(), kInfinity, scratch);
    Contact contact{};
    contact.flags = contact_overlap | contact_deep;
    contact.members = 1;
    contact.normal = way.normal;
    contact.lower = -way.length;
    contact.upper = -std::min(wall->lower, way.length);
    const Double3 last = ways.last_point(way.normal);
    constexpr std::uint64_t kNoTriangle = 0xffffffffU;
    const std::uint64_t id = source_number(*inner.model, own->triangle);
    if (enclosed.is_of_a) {
        put_triangle(inner, own->triangle, scratch, contact.piece_a, contact.feature_a);
        put_triangle(outer, wall->triangle, scratch, contact.piece_b, contact.feature_b);
        contact.id = id << 32 | kNoTriangle;
        contact.point_a = last;
        contact.point_b = last - way.length * way.normal;
    } else {
        put_triangle(outer, wall->triangle, scratch, contact.piece_a, contact.feature_a);
        put_triangle(inner, own->triangle, scratch, contact.piece_b, contact.feature_b);
        contact.id = kNoTriangle << 32 | id;
        contact.point_a = last + way.length * way.normal;
        contact.point_b = last;
    }
    if (manifold == Manifold::four) {
        contact.point_count = 1;
        contact.points[0] = {contact.point_a, contact.point_b, contact.lower, 0};
    }
    return contact;
}

}  // namespace cdprep
