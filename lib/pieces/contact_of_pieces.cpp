// SPDX-License-Identifier: MIT
#include "core/numbers.h"
#include "pieces/contact_steps.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "hull/hull_nearest.h"
#include "pieces/way_points.h"
#include "pieces/ways_out.h"

namespace cdprep {
namespace {

/// The largest width of the interval of a depth, beside the rounding of moved corners: of the
/// depth, and of the size of both hulls.
constexpr double kRelative = 1e-12;
constexpr double kOfSize = 1e-12;
/// The maximum number of a piece's triangles whose normals are tried as ways out of a hull that is
/// too large to try all.
constexpr std::size_t kMostNormals = 128;
/// Of a larger piece, only the normals nearest to the penetration depth's are tried.
constexpr std::size_t kMostNearNormals = 16;
/// The cosine of the angle between two unit directions up to which rounding may turn one behind the
/// other.
constexpr double kBeside = 1e-9;
/// The gap, as a share of coordinates, up to which the direction across it is not sure. Across a
/// larger gap between two vertices, it is off by less than 1e-5.
constexpr double kRest = 0x1p-36;
/// How many times shorter an exit must be to be preferred to one that ends at both surfaces.
constexpr double kMuchShorter = 2;

/// Returns nearest_direction(), also for corners whose products leave the range of double.
Double3 direction_of(const NearestSimplex& simplex) {
    double most = 0;
    for (std::size_t i = 0; i < simplex.count; ++i) {
        most = std::max(most, largest_of(simplex.corner[i].at));
    }
    constexpr double kLeast = 0x1p-200, kMost = 0x1p200;
    if ((most > kLeast && most < kMost) || most == 0) return nearest_direction(simplex);
    const int by = -std::ilogb(most);
    NearestSimplex scaled = simplex;
    for (std::size_t i = 0; i < scaled.count; ++i) {
        Double3& at = scaled.corner[i].at;
        at = {std::scalbn(at.x, by), std::scalbn(at.y, by), std::scalbn(at.z, by)};
    }
    return nearest_direction(scaled);
}

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

/// Returns the places of the greatest values above 0, in falling order, as many as `room` holds.
std::span<const std::uint32_t> greatest_places(std::span<const float> values,
                                               std::span<std::uint32_t> room) {
    std::size_t count = 0;
    for (std::uint32_t place = 0; place < values.size(); ++place) {
        const float value = values[place];
        if (!(value > 0)) continue;
        if (count == room.size() && !(value > values[room.back()])) continue;
        std::size_t i = count < room.size() ? count++ : count - 1;
        for (; i > 0 && value > values[room[i - 1]]; --i) room[i] = room[i - 1];
        room[i] = place;
    }
    return room.first(count);
}

/// The features of two pieces at a contact.
struct Meeting {
    PieceFeature a;
    PieceFeature b;
};

/// Two features and their nearest points.
struct NearMeeting : Meeting {
    HullNearest nearest;
};

class PairOfPieces {
public:
    PairOfPieces(ContactSide& a, ContactSide& b, const NearPieces& near,
                 const ContactQuestion& question) noexcept
        : a_(a), b_(b), near_(near), question_(question) {}

    [[nodiscard]] Contact answer() noexcept {
        Contact contact{};
        contact.piece_a = static_cast<std::uint32_t>(near_.key >> 32);
        contact.piece_b = static_cast<std::uint32_t>(near_.key);
        contact.id = std::uint64_t{a_.source_triangle()} << 32 | b_.source_triangle();
        contact.members = 1;
        a_.place_triangles();
        b_.place_triangles();
        const Meeting meeting = find(contact);
        contact.feature_a = a_.in_source(meeting.a);
        contact.feature_b = b_.in_source(meeting.b);
        if (question_.options.manifold == Manifold::four) {
            add_manifold(a_, b_, meeting.a, meeting.b, question_.options.tolerance, contact);
        }
        return contact;
    }

private:
    /// Fills in the distance, the normal and the points. If triangles touch, so do the hulls.
    [[nodiscard]] Meeting find(Contact& contact) noexcept {
        const bool both_contained = a_.is_contained() && b_.is_contained();
        // A complete search knows whether triangles touch, which decides the ways that are tried.
        if (both_contained && !question_.searched && !near_.touch) find_touch();
        WaysOut ways;
        const bool has_ways = (near_.touch || both_contained) && find_all(ways);
        if (has_ways && (near_.touch || ways.least() > 0)) {
            return answer_overlap(ways, std::max(0.0, ways.least()), contact);
        }
        const TwoHulls hulls = {a_.hull(), b_.hull()};
        const auto nearest = hull_nearest(hulls.a, hulls.b, {}, nullptr, question_.counts);
        const bool may_touch =
            !both_contained && !question_.searched && !near_.touch && nearest->bounds.lower <= 0;
        if (may_touch && find_touch()) return find(contact);
        if (nearest->meet && has_ways) return answer_overlap(ways, 0, contact);
        const bool is_at_rest = !nearest->meet && nearest->bounds.upper <= rest();
        if (is_at_rest && (has_ways || find_all(ways))) {
            return answer_at_rest(ways, *nearest, contact);
        }
        if (!nearest->meet || !(both_contained || near_.touch)) {
            return answer_apart(*nearest, contact);
        }
        const Penetration depth = hull_depth(hulls, nearest->simplex, {}, question_.counts);
        find_some(depth, ways);
        return answer_overlap(ways, depth.lower, contact);
    }

    /// Looks for triangles that touch. Returns whether there are any.
    bool find_touch() noexcept {
        const auto found = touching_triangles(a_, b_, question_);
        if (found) near_ = {near_.key, found->a, found->b, true};
        return found.has_value();
    }

    // --- Apart ----------------------------------------------------------------------

    /// Returns the gap up to which rounding may turn the direction across it.
    [[nodiscard]] double rest() const noexcept {
        const auto size_of = [](const ContactSide& side) {
            const std::uint32_t last = side.points().count - 1;  // the first may be at the origin
            return std::max(largest_of(side.corner(0)), largest_of(side.corner(last)));
        };
        return kRest * (size_of(a_) + size_of(b_));
    }

    /// Returns the features of the hulls if triangles have them, otherwise those of the nearest
    /// triangles.
    [[nodiscard]] NearMeeting nearest_features(const HullNearest& hulls) const noexcept {
        if (!hulls.meet) {
            const auto a =
                a_.find_feature(vertices_of(hulls.simplex, &Difference::a, a_.points().corners),
                                [&] { return weighted_sum(hulls.simplex, &Difference::at_a); });
            const auto b =
                b_.find_feature(vertices_of(hulls.simplex, &Difference::b, b_.points().corners),
                                [&] { return weighted_sum(hulls.simplex, &Difference::at_b); });
            if (a && b) return {{*a, *b}, hulls};
        }
        return triangle_features();
    }
    [[nodiscard]] NearMeeting triangle_features() const noexcept {
        const TreePair start = {near_.a, near_.b};
        const auto [pair, least] = near_.touch
                                       ? NearestTriangles{start, kInfinity}
                                       : nearest_triangles(a_, b_, start, question_.degenerate);
        const ConvexPoints of_a = a_.points_of(pair.a), of_b = b_.points_of(pair.b);
        const TwoHulls triangles(of_a, of_b, *question_.placement);
        auto nearest = hull_nearest(triangles.a, triangles.b, {}, nullptr, question_.counts);
        nearest->bounds.lower = std::min(nearest->bounds.lower, least);
        const VertexSet at_a = vertices_of(nearest->simplex, &Difference::a, of_a.corners);
        const VertexSet at_b = vertices_of(nearest->simplex, &Difference::b, of_b.corners);
        return {{feature_of(a_, pair.a, at_a), feature_of(b_, pair.b, at_b)}, *nearest};
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
        const NearMeeting meeting = nearest_features(hulls);
        contact.point_a = weighted_sum(meeting.nearest.simplex, &Difference::at_a);
        contact.point_b = weighted_sum(meeting.nearest.simplex, &Difference::at_b);
        contact.lower = meeting.nearest.bounds.lower;
        contact.upper = meeting.nearest.bounds.upper;
        contact.normal = normal_between(meeting, contact);
        if (contact.upper <= rest()) contact.normal = unless_behind(contact.normal);
        if (a_.is_seen_from_behind(meeting.a, contact.normal) ||
            b_.is_seen_from_behind(meeting.b, -contact.normal)) {
            contact.flags |= contact_from_behind;
        }
        const bool is_across_face =
            meeting.a.kind == FeatureKind::face || meeting.b.kind == FeatureKind::face;
        if (is_across_face && !leaves_along_plane(meeting, contact.normal)) return meeting;
        // The normal must not point away from B. It may be perpendicular to the gap: B may hang
        // over the border of a floor triangle.
        const auto upright = upright_normal(meeting, contact.normal);
        if (upright && dot(*upright, contact.normal) >= -kBeside) {
            contact.normal = *upright;
            contact.flags |= contact_internal_edge;
        }
        return meeting;
    }

    /// Returns the contact normal. It is computed from a face or from two edges alone, so it is
    /// exact up to its sign, which needs a gap that rounding does not reach.
    [[nodiscard]] Double3 normal_between(const NearMeeting& meeting,
                                         const Contact& contact) const noexcept {
        const Double3 gap = direction_of(meeting.nearest.simplex);
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

    /// Returns the opposite of a normal if hulls that hardly meet part along that alone: across so
    /// small a gap, the sign is rounding.
    [[nodiscard]] Double3 unless_behind(const Double3& normal) const noexcept {
        if (!(dot(normal, normal) > 0)) return normal;
        const double back = length_along(-normal);
        return back <= rest() && back < length_along(normal) ? -normal : normal;
    }

    [[nodiscard]] std::optional<Double3> upright_normal(const Meeting& meeting,
                                                        const Double3& normal) const noexcept {
        const auto by_a = shortest_of(a_.upright(meeting.a, normal));
        const auto by_b = shortest_of(-b_.upright(meeting.b, -normal));
        const bool takes_b = by_b && (!by_a || dot(*by_b, normal) > dot(*by_a, normal));
        const auto& upright = takes_b ? by_b : by_a;
        return upright ? std::optional(shorter_of_both_ways(*upright)) : std::nullopt;
    }
    /// Returns the direction along which B leaves A soonest, either way.
    [[nodiscard]] std::optional<Double3> shortest_of(const UnitDirections& all) const noexcept {
        if (all.count == 0) return std::nullopt;
        const auto length = [&](const Double3& way) {
            return length_along(shorter_of_both_ways(way));
        };
        std::size_t best = 0;
        for (std::size_t i = 1; i < all.count; ++i) {
            if (length(all.way[i]) < length(all.way[best])) best = i;
        }
        return all.way[best];
    }

    /// Returns `normal` or its opposite. On a surface that bounds no solid both are upright, and
    /// the shorter way out leads towards more of the other piece.
    [[nodiscard]] Double3 shorter_of_both_ways(const Double3& normal) const noexcept {
        if (a_.is_contained() && b_.is_contained()) return normal;
        return length_along(-normal) < length_along(normal) ? -normal : normal;
    }

    // --- Overlapping ----------------------------------------------------------------

    /// A way in which B leaves A.
    struct Exit {
        WayOut way;
        Meeting meeting;   ///< the features there
        std::size_t rank;  ///< the number of shorter ways
        bool has_points = false;
        Double3 point_a{};
        Double3 point_b{};
    };

    /// Finds every way that may be the shortest. Returns false if that is too much work, or if the
    /// bound of the shortest is too far from it.
    [[nodiscard]] bool find_all(WaysOut& ways) noexcept {
        const Double3 origin = a_.corner(0);
        const PieceShape* shape_a = a_.shape(origin);
        const PieceShape* shape_b = shape_a == nullptr ? nullptr : b_.shape(origin);
        if (shape_b == nullptr || !ways.find(*shape_a, *shape_b, near_.touch)) return false;
        if (question_.counts != nullptr) question_.counts->hull_pairs += 1;
        const double shortest = ways[0].length;
        const double size = shape_a->reach() + shape_b->reach();
        return shortest - ways.least() <=
               kRelative * shortest + kOfSize * size + 4 * ways.position_error();
    }
    /// Takes the shortest way, and the normals of the triangles of both pieces.
    void find_some(const Penetration& depth, WaysOut& ways) const noexcept {
        ways.clear();
        ways.add(depth.normal, depth.upper);
        const auto add = [&](const Double3& normal) {
            if (dot(normal, normal) > 0) ways.add(normal, about_way_out(normal));
        };
        each_normal(a_, depth.normal, add);
        each_normal(b_, -depth.normal, [&](const Double3& normal) { add(-normal); });
    }
    /// Calls visit(normal) for the normals of triangles, or of the faces that face a unit direction
    /// most.
    template <class Visit>
    static void each_normal(const ContactSide& side, const Double3& direction,
                            Visit&& visit) noexcept {
        std::array<float, PlacedHull::kMostFacets> room;
        const auto triangles = side.triangles();
        const auto cosines = triangles.size() <= kMostNormals ? std::span<const float>()
                                                              : side.face_cosines(direction, room);
        if (cosines.empty()) {
            for (const std::uint32_t t : triangles.first(std::min(triangles.size(), kMostNormals)))
                visit(side.normal_of(t));
            return;
        }
        std::array<std::uint32_t, kMostNearNormals> nearest;
        for (const std::uint32_t f : greatest_places(cosines, nearest)) {
            const auto& c = side.facets()[f].corner;
            visit(unit_normal({side.corner(c[0]), side.corner(c[1]), side.corner(c[2])}));
        }
    }

    /// `depth` is a lower bound of the length of every way out.
    [[nodiscard]] Meeting answer_overlap(WaysOut& ways, double depth,
                                         Contact& contact) const noexcept {
        const Meeting meeting = take_exit(ways, contact);
        contact.flags |= contact_overlap;
        contact.lower = -std::max(length_along(contact.normal), depth);
        contact.upper = -depth;
        return meeting;
    }
    /// Fills in the normal and the points of the best exit. Returns the features there.
    [[nodiscard]] Meeting take_exit(WaysOut& ways, Contact& contact) const noexcept {
        Exit exit = best_exit(ways);
        set_points(exit);
        if (exit.rank > 0) contact.flags |= contact_internal_edge;
        contact.normal = exit.way.normal;
        contact.point_a = exit.point_a;
        contact.point_b = exit.point_b;
        // Faces are known by their triangles at the points.
        return {a_.feature_along(contact.normal, exit.point_a),
                b_.feature_along(-contact.normal, exit.point_b)};
    }

    /// The same for hulls that are apart by rounding: the normal and the features are those of the
    /// way out, as if they overlapped as little.
    [[nodiscard]] Meeting answer_at_rest(WaysOut& ways, const HullNearest& hulls,
                                         Contact& contact) const noexcept {
        const DistanceBounds bounds = nearest_features(hulls).nearest.bounds;
        const Meeting meeting = take_exit(ways, contact);
        contact.lower = bounds.lower;
        contact.upper = bounds.upper;
        return meeting;
    }

    /// Returns whether B leaves A along a direction through a face that no triangle covers: deeper
    /// into the solid, not out of it.
    [[nodiscard]] bool leads_inside(const Meeting& meeting,
                                    const Double3& direction) const noexcept {
        return (a_.is_contained() && !a_.leads_out(meeting.a, direction)) ||
               (b_.is_contained() && !b_.leads_out(meeting.b, -direction));
    }
    /// Returns whether an exit leads past a reflex edge at which a face ends: into what the cut
    /// into pieces left on the other side.
    [[nodiscard]] bool leads_through_cut(Exit& exit) const noexcept {
        const Double3& normal = exit.way.normal;
        const bool by_a = may_end(a_, exit.meeting.a, normal);
        const bool by_b = may_end(b_, exit.meeting.b, -normal);
        if (!by_a && !by_b) return false;
        set_points(exit);
        return (by_a && ends_before(a_, normal, exit.point_a, b_)) ||
               (by_b && ends_before(b_, -normal, exit.point_b, a_));
    }
    static bool may_end(const ContactSide& side, const PieceFeature& feature,
                        const Double3& out) noexcept {
        return side.is_contained() && feature.kind == FeatureKind::face &&
               side.ends_at_reflex_edge(out);
    }
    /// Returns whether a face ends before a point, and `other` crosses its plane beyond it alone.
    [[nodiscard]] bool ends_before(const ContactSide& side, const Double3& out, const Double3& at,
                                   const ContactSide& other) const noexcept {
        const double most = rest();
        return !side.has_face_at(out, at, most) && side.ends_before(out, at, most) &&
               other.reach(out, at) > most && !side.has_face_at(out, other.hull(), most);
    }
    /// Returns whether a direction leans over an edge where a surface continues.
    [[nodiscard]] bool leans(const Meeting& meeting, const Double3& direction) const noexcept {
        return a_.leans_over_edge(meeting.a, direction) ||
               b_.leans_over_edge(meeting.b, -direction);
    }
    /// Returns whether B leaves A along a direction by the end of a plane that continues.
    [[nodiscard]] bool leaves_along_plane(const Meeting& meeting,
                                          const Double3& direction) const noexcept {
        return a_.leans_over_flat_edge(meeting.a, direction) ||
               b_.leans_over_flat_edge(meeting.b, -direction);
    }
    /// Returns the shortest exit that ends at both surfaces. Prefers another one that is shorter by
    /// kMuchShorter and leads neither along a plane nor deeper into a solid. Without either,
    /// returns the direction of the shortest exit along a plane, turned upright. Without that too,
    /// returns the shortest way itself.
    [[nodiscard]] Exit best_exit(WaysOut& ways) const noexcept {
        std::optional<Exit> other, leaning;
        for (std::size_t i = 0; i < ways.count(); ++i) {
            const WayOut& way = ways[i];
            if (other && way.length > kMuchShorter * other->way.length) break;
            const std::optional<Meeting> meeting = features_across(way);
            if (!meeting || leads_inside(*meeting, way.normal)) continue;
            const bool is_leaning = leans(*meeting, way.normal);
            const bool is_other = is_leaning && !other && !leaves_along_plane(*meeting, way.normal);
            if (is_leaning && leaning && !is_other) continue;
            Exit exit = {way, *meeting, i};
            if (leads_through_cut(exit)) continue;
            if (!is_leaning) return exit;
            if (!leaning) leaning = exit;
            if (is_other) other = exit;
        }
        if (other) return *other;
        if (!leaning) return {ways[0], {}, 0};
        const auto upright = upright_normal(leaning->meeting, leaning->way.normal);
        return {{upright.value_or(ways[0].normal), 0, WayKind::other, 0, 0}, {}, ways.count()};
    }

    /// Returns the features across which a way leads, with any triangle of a face. Returns nothing
    /// if it leads through a face or an edge of a hull that no triangle has: deeper into the solid.
    [[nodiscard]] std::optional<Meeting> features_across(const WayOut& way) const noexcept {
        if (way.kind == WayKind::edges) return edges_across(way);
        const auto on_a = [&] { return way_points(a_, b_, way.normal).on_a; };
        const auto on_b = [&] { return way_points(a_, b_, way.normal).on_b; };
        const auto a = way.kind == WayKind::face_a ? face_of(a_, way.a, way.normal, on_a)
                                                   : farthest_of(a_, way.normal, on_a);
        if (!a) return std::nullopt;
        const auto b = way.kind == WayKind::face_b ? face_of(b_, way.b, -way.normal, on_b)
                                                   : farthest_of(b_, -way.normal, on_b);
        if (!b) return std::nullopt;
        return Meeting{*a, *b};
    }
    [[nodiscard]] std::optional<Meeting> edges_across(const WayOut& way) const noexcept {
        const auto on_a = [&] { return points_on_edges(way).on_a; };
        const auto a = edge_of(a_, way.a, on_a);
        if (!a) return std::nullopt;
        const auto on_b = [&] { return points_on_edges(way).on_b; };
        const auto b = edge_of(b_, way.b, on_b);
        if (!b) return std::nullopt;
        return Meeting{*a, *b};
    }
    /// `point()` returns the point of the side that the way leads from.
    template <class Point>
    static std::optional<PieceFeature> edge_of(const ContactSide& side, std::uint8_t place,
                                               Point&& point) noexcept {
        const PieceShape::Edge& edge = side.shape()->edges()[place];
        VertexSet ends;
        ends.add(side.points().corners[edge.from]);
        ends.add(side.points().corners[edge.to]);
        const auto feature = side.find_feature(ends, point);
        if (feature || side.is_contained()) return feature;
        return PieceFeature{FeatureKind::face, side.triangles()[0], 0};
    }
    template <class Point>
    static std::optional<PieceFeature> face_of(const ContactSide& side, std::uint8_t place,
                                               const Double3& normal, Point&& point) noexcept {
        if (const auto face = side.find_face(normal, nullptr)) return face;
        const PieceShape::Face& face = side.shape()->faces()[place];
        if (side.is_contained() && !face.is_covered) return std::nullopt;
        return farthest_of(side, normal, point);
    }
    template <class Point>
    static std::optional<PieceFeature> farthest_of(const ContactSide& side,
                                                   const Double3& direction,
                                                   Point&& point) noexcept {
        if (const auto face = side.find_face(direction, nullptr)) return face;
        const auto feature = side.find_feature(side.farthest_vertices(direction), point);
        if (feature || side.is_contained()) return feature;
        return PieceFeature{FeatureKind::face, side.triangles()[0], 0};
    }

    /// Sets the points of an exit: where two edges cross, or where the farthest corners of both
    /// pieces are over each other.
    void set_points(Exit& exit) const noexcept {
        if (exit.has_points) return;
        exit.has_points = true;
        const WayPoints points = exit.way.kind == WayKind::edges
                                     ? points_on_edges(exit.way)
                                     : way_points(a_, b_, exit.way.normal);
        exit.point_a = points.on_a;
        exit.point_b = points.on_b;
    }
    /// Returns the points where the edges of a way are nearest to each other.
    [[nodiscard]] WayPoints points_on_edges(const WayOut& way) const noexcept {
        const PieceShape::Edge& a = a_.shape()->edges()[way.a];
        const PieceShape::Edge& b = b_.shape()->edges()[way.b];
        const Double3 from_a = a_.corner(a.from), from_b = b_.corner(b.from);
        const Double3 along_a = a_.corner(a.to) - from_a, along_b = b_.corner(b.to) - from_b;
        const Double3 gap = from_b - from_a;
        const Double3 across_a = cross(way.normal, along_a);
        const Double3 across_b = cross(way.normal, along_b);
        const double at_a = dot(gap, across_b) / dot(along_a, across_b);
        const double at_b = -dot(gap, across_a) / dot(along_b, across_a);
        return {from_a + std::clamp(at_a, 0.0, 1.0) * along_a,
                from_b + std::clamp(at_b, 0.0, 1.0) * along_b};
    }

    [[nodiscard]] double about_way_out(const Double3& direction) const noexcept {
        const MovedHull a = a_.hull(), b = b_.hull();
        return dot(direction,
                   a.point(a.farthest(direction, 0)) - b.point(b.farthest(-direction, 0)));
    }
    /// Returns the distance that B must move along a unit direction to be out of A: an upper bound,
    /// rounding included.
    [[nodiscard]] double length_along(const Double3& direction) const noexcept {
        assert(dot(direction, direction) > 0);
        const Double3 origin = a_.corner(a_.hull().farthest(direction, 0));
        const double sum =
            std::max(0.0, a_.reach(direction, origin) + b_.reach(-direction, origin));
        const double shortest = std::sqrt(dot(direction, direction)) * (1 - 4 * kUnit);
        return sum / shortest * (1 + 4 * kUnit);
    }

    ContactSide& a_;
    ContactSide& b_;
    NearPieces near_;
    const ContactQuestion& question_;
};

}  // namespace

double most_depth_of_pieces(const ContactSide& a, const ContactSide& b,
                            const NearPieces& near) noexcept {
    double most = std::numeric_limits<double>::infinity();
    const auto look = [&](const Double3& normal, const Double3& from) {
        const double squared = dot(normal, normal);
        if (!(squared > 0)) return;
        const double way = a.rough_reach(normal, from) + b.rough_reach(-normal, from);
        // A bound of a positive length rounds up, and one of a distance down.
        const double rounding = way > 0 ? 1 + 8 * kUnit : 1 - 8 * kUnit;
        most = std::min(most, way / std::sqrt(squared) * rounding);
    };
    const Corners at_a = a.model().corners(near.a), at_b = b.model().corners(near.b);
    const Double3 normal_a = unit_normal(at_a), normal_b = unit_normal(at_b);
    look(normal_a, at_a[0]);
    look(-normal_b, at_a[0]);
    if (!a.is_contained()) look(-normal_a, at_a[0]);
    if (!b.is_contained()) look(normal_b, at_a[0]);
    return most;
}

double most_depth_by_faces(ContactSide& a, ContactSide& b, const NearPieces& near) noexcept {
    const Double3 origin = a.corner(0);
    const PieceShape* shape_a = a.shape(origin);
    const PieceShape* shape_b = shape_a == nullptr ? nullptr : b.shape(origin);
    if (shape_b == nullptr) return kInfinity;
    const double most = shortest_way_by_faces(*shape_a, *shape_b);
    return near.touch ? std::max(0.0, most) : most;
}

Contact contact_of_pieces(ContactSide& a, ContactSide& b, const NearPieces& near,
                          const ContactQuestion& question) noexcept {
    return PairOfPieces(a, b, near, question).answer();
}

}  // namespace cdprep
