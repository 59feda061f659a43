// SPDX-License-Identifier: MIT
#include "pieces/contact_steps.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "hull/hull_nearest.h"

namespace cdprep {
namespace {

constexpr double kUnit = 0x1p-53;
/// The maximum number of a piece's triangles whose normals are tried as ways out.
constexpr std::size_t kMostWays = 256;
/// The maximum number of ways out, the shortest first, that are examined for what lies beyond.
constexpr std::size_t kMostExits = 16;
/// How many times shorter an exit must be to be preferred to one that ends at both surfaces.
constexpr double kMuchShorter = 2;

/// Returns the vertices that define a nearest point.
VertexSet vertices_of(const NearestSimplex& simplex, std::uint32_t Difference::*side,
                      std::span<const std::uint32_t> corners) {
    VertexSet set;
    for (std::size_t i = 0; i < simplex.count; ++i) {
        assert(simplex.corner[i].*side < corners.size());
        set.add(corners[simplex.corner[i].*side]);
    }
    return set;
}

/// Two features and their nearest points.
struct Meeting {
    PieceFeature a;
    PieceFeature b;
    HullNearest nearest;
};

class PairOfPieces {
public:
    PairOfPieces(const ContactSide& a, const ContactSide& b, const NearPieces& near,
                 const ContactQuestion& question) noexcept
        : a_(a), b_(b), near_(near), question_(question) {}

    [[nodiscard]] Contact answer() const noexcept {
        Contact contact{};
        contact.piece_a = static_cast<std::uint32_t>(near_.key >> 32);
        contact.piece_b = static_cast<std::uint32_t>(near_.key);
        const TwoHulls hulls = {a_.hull(), b_.hull()};
        const auto nearest = hull_nearest(hulls.a, hulls.b, {}, nullptr, question_.counts);
        const bool both_contained = a_.is_contained() && b_.is_contained();
        const Meeting meeting = nearest->meet && (both_contained || near_.touch)
                                    ? answer_overlap(hulls, nearest->simplex, contact)
                                    : answer_apart(*nearest, contact);
        contact.feature_a = a_.in_source(meeting.a);
        contact.feature_b = b_.in_source(meeting.b);
        if (question_.options.manifold == Manifold::four) {
            add_manifold(a_, b_, meeting.a, meeting.b, question_.options.tolerance, contact);
        }
        return contact;
    }

private:
    // --- Apart ----------------------------------------------------------------------

    /// Returns the features of the hulls if triangles have them, otherwise those of the nearest
    /// triangles.
    [[nodiscard]] Meeting nearest_features(const HullNearest& hulls) const noexcept {
        if (!hulls.meet) {
            const auto a =
                a_.find_feature(vertices_of(hulls.simplex, &Difference::a, a_.points().corners));
            const auto b =
                b_.find_feature(vertices_of(hulls.simplex, &Difference::b, b_.points().corners));
            if (a && b) return {*a, *b, hulls};
        }
        return triangle_features();
    }
    [[nodiscard]] Meeting triangle_features() const noexcept {
        const TreePair pair =
            near_.touch ? TreePair{near_.a, near_.b}
                        : nearest_triangles(a_, b_, {near_.a, near_.b}, question_.degenerate);
        const ConvexPoints of_a = a_.points_of(pair.a), of_b = b_.points_of(pair.b);
        const TwoHulls triangles(of_a, of_b, *question_.placement);
        const auto nearest = hull_nearest(triangles.a, triangles.b, {}, nullptr, question_.counts);
        const VertexSet at_a = vertices_of(nearest->simplex, &Difference::a, of_a.corners);
        const VertexSet at_b = vertices_of(nearest->simplex, &Difference::b, of_b.corners);
        return {feature_of(a_, pair.a, at_a), feature_of(b_, pair.b, at_b), *nearest};
    }
    static PieceFeature feature_of(const ContactSide& side, std::uint32_t triangle,
                                   const VertexSet& set) noexcept {
        const auto& vertex = side.model().model->mesh().triangles[triangle].vertex;
        const auto place = [&](std::uint32_t number) {
            const auto* at = std::find(vertex.begin(), vertex.end(), number);
            assert(at != vertex.end());
            return static_cast<std::uint32_t>(at - vertex.begin());
        };
        if (set.count == 1) return {FeatureKind::vertex, triangle, place(set.vertex[0])};
        if (set.count > 2) return {FeatureKind::face, triangle, 0};
        const std::uint32_t first = place(set.vertex[0]), second = place(set.vertex[1]);
        return {FeatureKind::edge, triangle, (first + 1) % 3 == second ? first : second};
    }

    [[nodiscard]] Meeting answer_apart(const HullNearest& hulls, Contact& contact) const noexcept {
        const Meeting meeting = nearest_features(hulls);
        contact.point_a = weighted_sum(meeting.nearest.simplex, &Difference::at_a);
        contact.point_b = weighted_sum(meeting.nearest.simplex, &Difference::at_b);
        contact.lower = meeting.nearest.bounds.lower;
        contact.upper = meeting.nearest.bounds.upper;
        contact.normal = normal_between(meeting, contact);
        if (a_.is_seen_from_behind(meeting.a, contact.normal) ||
            b_.is_seen_from_behind(meeting.b, -contact.normal)) {
            contact.flags |= contact_from_behind;
        }
        if (const auto upright = upright_normal(meeting, contact.normal)) {
            contact.normal = *upright;
            contact.flags |= contact_internal_edge;
        }
        return meeting;
    }

    /// Returns the contact normal. It is computed from a face or from two edges alone, so it is
    /// exact however small the gap is.
    [[nodiscard]] Double3 normal_between(const Meeting& meeting,
                                         const Contact& contact) const noexcept {
        const Double3 gap = nearest_direction(meeting.nearest.simplex);
        const Double3 towards = -gap;  // of A - B, and the normal leads to B
        Double3 normal{};
        if (meeting.a.kind == FeatureKind::face) {
            normal = a_.normal_of(meeting.a.triangle);
        } else if (meeting.b.kind == FeatureKind::face) {
            normal = b_.normal_of(meeting.b.triangle);
        }
        if (dot(normal, normal) > 0) return dot(normal, towards) < 0 ? -normal : normal;
        const Double3 way = dot(towards, towards) > 0 ? towards : contact.point_b - contact.point_a;
        return dot(way, way) > 0 ? unit(way) : a_.normal_of(meeting.a.triangle);
    }

    [[nodiscard]] std::optional<Double3> upright_normal(const Meeting& meeting,
                                                        const Double3& normal) const noexcept {
        const auto by_a = a_.upright(meeting.a, normal);
        auto by_b = b_.upright(meeting.b, -normal);
        if (by_b) by_b = -*by_b;
        const bool takes_b = by_b && (!by_a || dot(*by_b, normal) > dot(*by_a, normal));
        const auto& upright = takes_b ? by_b : by_a;
        return upright ? std::optional(shorter_of_both_ways(*upright)) : std::nullopt;
    }

    /// Returns `normal` or its opposite. On a surface that bounds no solid both are upright, and
    /// the shorter way out leads towards more of the other piece.
    [[nodiscard]] Double3 shorter_of_both_ways(const Double3& normal) const noexcept {
        if (a_.is_contained() && b_.is_contained()) return normal;
        return way_out(-normal).length < way_out(normal).length ? -normal : normal;
    }

    // --- Overlapping ----------------------------------------------------------------

    [[nodiscard]] Meeting answer_overlap(const TwoHulls& hulls, const NearestSimplex& common,
                                         Contact& contact) const noexcept {
        const Penetration depth = hull_depth(hulls, common, {}, question_.counts);
        contact.flags |= contact_overlap;
        contact.normal = depth.normal;
        contact.point_a = depth.witness_a;
        contact.point_b = depth.witness_b;
        contact.lower = -depth.upper;
        contact.upper = -depth.lower;
        Meeting meeting{};
        meeting.a = a_.feature_along(depth.normal, depth.witness_a);
        meeting.b = b_.feature_along(-depth.normal, depth.witness_b);
        const bool is_inside = leads_inside(meeting, depth.normal);
        const auto upright = is_inside ? std::nullopt : upright_normal(meeting, depth.normal);
        if (!is_inside && !upright) return meeting;
        const std::optional<Exit> exit = shortest_exit(upright);
        if (!exit) return meeting;
        contact.flags |= contact_internal_edge;
        contact.normal = exit->normal;
        contact.point_a = exit->point_a;
        contact.point_b = exit->point_b;
        contact.lower = std::min(contact.lower, -exit->length);
        return exit->meeting;
    }

    /// Returns whether B leaves A along a direction through a face that no triangle covers: deeper
    /// into the solid, not out of it.
    [[nodiscard]] bool leads_inside(const Meeting& meeting,
                                    const Double3& direction) const noexcept {
        return (a_.is_contained() && !a_.leads_out(meeting.a, direction)) ||
               (b_.is_contained() && !b_.leads_out(meeting.b, -direction));
    }
    /// Returns whether B leaves A along a direction by the end of a plane that continues.
    [[nodiscard]] bool leaves_along_plane(const Meeting& meeting,
                                          const Double3& direction) const noexcept {
        return a_.leans_over_flat_edge(meeting.a, direction) ||
               b_.leans_over_flat_edge(meeting.b, -direction);
    }
    /// Returns whether B leaves A along a direction where both surfaces end.
    [[nodiscard]] bool exits_at_surface(const Meeting& meeting,
                                        const Double3& direction) const noexcept {
        return !leads_inside(meeting, direction) && !a_.upright(meeting.a, direction) &&
               !b_.upright(meeting.b, -direction);
    }

    /// A way in which B leaves A.
    struct Exit {
        Double3 normal;
        double length;  ///< an upper bound, rounding included
        Double3 point_a;
        Double3 point_b;
        Meeting meeting;
    };

    /// Returns the shortest exit along the normal of a triangle of either piece. If a direction
    /// leaned over an edge, `upright` is that direction without the lean. Then `upright` counts as
    /// well, and exits along a plane do not. An exit that ends at both surfaces is preferred,
    /// unless another is shorter by kMuchShorter.
    [[nodiscard]] std::optional<Exit> shortest_exit(
        const std::optional<Double3>& upright) const noexcept {
        std::array<Way, 2 * kMostWays + 1> ways;
        std::size_t count = 0;
        const auto add = [&](const Double3& normal) {
            if (!(dot(normal, normal) > 0)) return;
            ways[count] = {about_way_out(normal), count, normal};
            ++count;
        };
        if (upright) add(*upright);
        for (const std::uint32_t t : first_triangles(a_)) add(a_.normal_of(t));
        for (const std::uint32_t t : first_triangles(b_)) add(-b_.normal_of(t));
        if (count == 0) return std::nullopt;
        std::sort(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(count),
                  [](const Way& x, const Way& y) {
                      return x.length != y.length ? x.length < y.length : x.number < y.number;
                  });
        if (!upright) return exit_along(ways[0].normal);
        std::optional<Exit> shortest;
        for (std::size_t i = 0; i < std::min(count, kMostExits); ++i) {
            if (shortest && ways[i].length > kMuchShorter * shortest->length) break;
            const Exit exit = exit_along(ways[i].normal);
            if (ways[i].number != 0 && leaves_along_plane(exit.meeting, exit.normal)) continue;
            if (exits_at_surface(exit.meeting, exit.normal)) return exit;
            if (!shortest) shortest = exit;
        }
        return shortest ? shortest : exit_along(*upright);
    }
    struct Way {
        double length;
        std::size_t number;
        Double3 normal;
    };
    static std::span<const std::uint32_t> first_triangles(const ContactSide& side) noexcept {
        return side.triangles().first(std::min(side.triangles().size(), kMostWays));
    }

    /// Returns the exit along a unit direction. Its points are the farthest point of the piece
    /// without a face there, and its foot on the other piece.
    [[nodiscard]] Exit exit_along(const Double3& normal) const noexcept {
        const WayOut way = way_out(normal);
        Exit exit = {normal, way.length, way.on_a, way.on_b, {}};
        exit.meeting.a = a_.feature_along(normal, way.on_b);
        if (exit.meeting.a.kind == FeatureKind::face) {
            exit.point_a = way.on_b + dot(normal, way.on_a - way.on_b) * normal;
        } else {
            exit.point_b = way.on_a + dot(normal, way.on_b - way.on_a) * normal;
        }
        exit.meeting.b = b_.feature_along(-normal, exit.point_b);
        return exit;
    }

    /// The distance that B must move along a unit direction to be out of A: an upper bound,
    /// rounding included.
    struct WayOut {
        double length;
        Double3 on_a;
        Double3 on_b;
    };
    [[nodiscard]] double about_way_out(const Double3& direction) const noexcept {
        const MovedHull a = a_.hull(), b = b_.hull();
        return dot(direction,
                   a.point(a.farthest(direction, 0)) - b.point(b.farthest(-direction, 0)));
    }
    [[nodiscard]] WayOut way_out(const Double3& direction) const noexcept {
        assert(dot(direction, direction) > 0);
        const MovedHull a = a_.hull(), b = b_.hull();
        const Double3 origin = a_.corner(0);
        const auto of_a = a.proven(direction, origin, a.farthest(direction, 0));
        const auto of_b = b.proven(-direction, origin, b.farthest(-direction, 0));
        const double sum = std::max(0.0, of_a.bound + of_b.bound);
        const double shortest = std::sqrt(dot(direction, direction)) * (1 - 4 * kUnit);
        return {sum / shortest * (1 + 4 * kUnit), a.point(of_a.number), b.point(of_b.number)};
    }

    const ContactSide& a_;
    const ContactSide& b_;
    const NearPieces& near_;
    const ContactQuestion& question_;
};

}  // namespace

Contact contact_of_pieces(const ContactSide& a, const ContactSide& b, const NearPieces& near,
                          const ContactQuestion& question) noexcept {
    return PairOfPieces(a, b, near, question).answer();
}

}  // namespace cdprep
