// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "cdprep/advanced/closest_features.h"
#include "cdprep/contacts.h"
#include "core/moved_model.h"
#include "core/triangle_facts.h"
#include "hull/hull_points.h"
#include "hull/moved_hull.h"
#include "pieces/piece_shape.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Returns a direction of length 1 up to rounding, or 0, 0, 0 for no direction.
inline Double3 unit(const Double3& d) noexcept {
    const double most = largest_of(d);
    if (!(most > 0)) return {0, 0, 0};
    const Double3 scaled = {d.x / most, d.y / most, d.z / most};
    return (1 / std::sqrt(dot(scaled, scaled))) * scaled;
}

/// Returns the normal of a triangle's front, of length 1 up to rounding, or 0, 0, 0 for one without
/// area.
inline Double3 unit_normal(const Corners& t) noexcept {
    const Double3 n = cross(t[1] - t[0], t[2] - t[0]);
    const double squared = dot(n, n);
    constexpr double kLeast = 0x1p-800, kMost = 0x1p800;  // no term has left the range of double
    if (squared > kLeast && squared < kMost) return (1 / std::sqrt(squared)) * n;
    return unit(cross(unit(t[1] - t[0]), unit(t[2] - t[0])));
}

/// Returns whether the cosine between a unit direction and either normal of a triangle is surely
/// less than `cosine`, which is above 0. Takes no root, and shows it of most triangles.
inline bool is_surely_turned(const Corners& t, const Double3& direction, double cosine) noexcept {
    const Double3 n = cross(t[1] - t[0], t[2] - t[0]);
    const double along = dot(n, direction), squared = dot(n, n);
    constexpr double kLeast = 0x1p-800, kMost = 0x1p800;  // no term has left the range of double
    constexpr double kRounding = 0.99;  // below 1 by far more than the roundings of both sides
    return squared > kLeast && squared < kMost &&
           along * along < kRounding * cosine * cosine * squared;
}

/// A triangle as moved.
struct PlacedTriangle {
    Corners at;
    Double3 normal;  ///< unit_normal()
};

/// A feature, given by a triangle in tree order.
struct PieceFeature {
    FeatureKind kind = FeatureKind::face;
    std::uint32_t triangle = 0;
    std::uint32_t corner = 0;  ///< the vertex, or the first of the edge
};

/// Some vertices of a model, each once.
struct VertexSet {
    std::array<std::uint32_t, 4> vertex{};
    std::size_t count = 0;

    void add(std::uint32_t number) noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            if (vertex[i] == number) return;
        }
        if (count < vertex.size()) vertex[count++] = number;
    }
};

/// The line through an edge of a hull.
class StraightEdge {
public:
    StraightEdge(const Double3& from, const Double3& to)
        : from_(from), along_(unit(to - from)), most_(kOnEdge * largest_of(to - from)) {}

    [[nodiscard]] bool has(const Double3& p) const {
        return largest_of(cross(p - from_, along_)) <= most_;
    }

private:
    /// How far a vertex may be beside an edge to divide it, as a share of its length. Files of
    /// floats round vertices by less.
    static constexpr double kOnEdge = 1e-6;

    Double3 from_;
    Double3 along_;
    double most_;
};

/// Unit directions any of which may be the normal of a contact.
struct UnitDirections {
    std::array<Double3, 4> way{};
    std::size_t count = 0;

    void add(const Double3& direction) noexcept {
        if (count < way.size()) way[count++] = direction;
    }
};
inline UnitDirections operator-(UnitDirections directions) noexcept {
    for (Double3& way : std::span(directions.way).first(directions.count)) way = -way;
    return directions;
}

/// A piece of one of the two models of a query.
class ContactSide {
public:
    /// The share of a hull's extent along a direction within which corners have equal height up to
    /// rounding.
    static constexpr double kLevel = 1e-9;

    /// `large` keeps the moved corners of a large piece from call to call; it may be null.
    ContactSide(const MovedModel& model, std::uint32_t piece, PlacedHull* large,
                Workspace::Storage& scratch) noexcept;
    ContactSide(const ContactSide&) = delete;  // placed_points_ refer to placed_
    ContactSide& operator=(const ContactSide&) = delete;
    ~ContactSide() = default;

    /// Moves the triangles, if they are few, so that what follows need not move them each time.
    void place_triangles() noexcept;

    [[nodiscard]] const MovedModel& model() const noexcept {
        return *model_;
    }
    [[nodiscard]] std::span<const std::uint32_t> triangles() const noexcept {
        return triangles_;
    }
    /// Returns the corners of a triangle as moved; `i` is its place in triangles().
    [[nodiscard]] Corners corners_of(std::size_t i) const noexcept {
        return i < placed_triangles_count_ ? placed_triangle_[i].at
                                           : model_->corners(triangles_[i]);
    }
    [[nodiscard]] std::span<const format::PieceFacet> facets() const noexcept {
        return hull_.facets;
    }
    [[nodiscard]] std::span<const format::PieceAdjacency> adjacency() const noexcept {
        return hull_.adjacency;
    }
    [[nodiscard]] bool is_contained() const noexcept {
        return contained_;
    }
    /// Returns the corners of the hull, or of a triangle, before they are moved.
    [[nodiscard]] const ConvexPoints& points() const noexcept {
        return hull_.points;
    }
    [[nodiscard]] ConvexPoints points_of(std::uint32_t triangle) const noexcept;
    /// Returns the hull as moved. Valid as long as this object.
    [[nodiscard]] MovedHull hull() const noexcept {
        return is_placed() ? MovedHull(placed_points_, nullptr)
                           : MovedHull(hull_.points, model_->pose);
    }
    [[nodiscard]] Double3 corner(std::uint32_t number) const noexcept {
        return is_placed() ? hull_point(placed_points_, number)
                           : model_->position(hull_.points.corners[number]);
    }
    /// Returns the largest distance of a moved corner from where exact arithmetic would move it.
    [[nodiscard]] double position_error() const noexcept;
    /// Returns the faces and edges of the hull relative to a point, the same at each call. Null if
    /// they cannot be tested (PieceShape::set()).
    [[nodiscard]] const PieceShape* shape(const Double3& origin) noexcept {
        if (has_shape_ == HasShape::unknown) {
            has_shape_ = shape_.set(*this, origin) ? HasShape::yes : HasShape::no;
        }
        return has_shape_ == HasShape::yes ? &shape_ : nullptr;
    }
    /// Returns the shape that shape() returned before.
    [[nodiscard]] const PieceShape* shape() const noexcept {
        return has_shape_ == HasShape::yes ? &shape_ : nullptr;
    }
    [[nodiscard]] Double3 normal_of(std::uint32_t triangle) const noexcept {
        return unit_normal(model_->corners(triangle));
    }

    /// Returns the feature that one to three vertices span, if a triangle of the piece has them
    /// all. The first of several triangles counts.
    [[nodiscard]] std::optional<PieceFeature> find_feature(const VertexSet& set) const noexcept;
    /// The same for vertices of the hull, up to four. Of an edge that the mesh divides, returns the
    /// part that is nearest to point().
    template <class Point>
    [[nodiscard]] std::optional<PieceFeature> find_feature(const VertexSet& set,
                                                           Point&& point) const noexcept {
        if (const auto feature = find_feature(set)) return feature;
        const auto edge = find_divided_edge(set);
        return edge ? find_part_of_edge(*edge, point()) : std::nullopt;
    }

    /// Returns a triangle of the piece that faces a unit direction squarely: the nearest to a point
    /// or, if that is null, the first.
    [[nodiscard]] std::optional<PieceFeature> find_face(const Double3& direction,
                                                        const Double3* near) const noexcept;

    /// Returns whether a triangle that faces a unit direction squarely is at most `most` away from
    /// a point, or from a hull.
    [[nodiscard]] bool has_face_at(const Double3& direction, const Double3& point,
                                   double most) const noexcept;
    [[nodiscard]] bool has_face_at(const Double3& direction, const MovedHull& hull,
                                   double most) const noexcept;
    /// Returns whether one of those triangles has a reflex edge.
    [[nodiscard]] bool ends_at_reflex_edge(const Double3& direction) const noexcept;
    /// Returns whether those triangles end at a reflex edge before a point of their plane: what is
    /// there is solid. Lengths up to `most` count as 0.
    [[nodiscard]] bool ends_before(const Double3& direction, const Double3& point,
                                   double most) const noexcept;

    /// Returns the feature that is farthest along a unit direction. Of several triangles in a face
    /// there, it names the nearest to a point.
    [[nodiscard]] PieceFeature feature_along(const Double3& direction,
                                             const Double3& near) const noexcept;
    /// Returns the vertices of the hull that are farthest along a unit direction, up to rounding.
    [[nodiscard]] VertexSet farthest_vertices(const Double3& direction) const noexcept;

    /// Returns the cosines of the angles between a unit direction and the normals of the faces of a
    /// large hull. Each is at the place of its face's first facet; other facets have 0. Each is off
    /// by at most kCosineError. Returns nothing for a hull that is small or too large to keep.
    [[nodiscard]] std::span<const float> face_cosines(
        const Double3& direction, std::array<float, PlacedHull::kMostFacets>& room) const noexcept;
    static constexpr float kCosineError = 1e-6F;

    /// Returns a bound of how far any corner is from a point along a direction, rounding included.
    [[nodiscard]] double reach(const Double3& direction, const Double3& from) const noexcept;
    /// Returns a bound that may be greater by some rounding errors of the hull's size. Of a large
    /// hull it takes less time.
    [[nodiscard]] double rough_reach(const Double3& direction, const Double3& from) const noexcept {
        return large_ != nullptr ? hull().bound_along(direction, from) : reach(direction, from);
    }

    /// Returns whether the way out of the piece along a unit direction leads away from the solid.
    /// It does if a triangle with the feature faces that direction. It also does if it leads along
    /// such a triangle over a convex edge, where the next triangle faces it.
    [[nodiscard]] bool leads_out(const PieceFeature& feature,
                                 const Double3& direction) const noexcept;
    /// Returns whether the space in a unit direction is clearly inside the solid. Then the
    /// direction is behind all triangles with the feature.
    [[nodiscard]] bool is_seen_from_behind(const PieceFeature& feature,
                                           const Double3& direction) const noexcept;

    /// Returns a unit direction at a feature, changed so that it does not lean over edges where the
    /// surface continues. Returns none when it does not lean over any, or if the feature is a
    /// vertex beyond which the surface does not go. If it leads from a vertex straight across
    /// edges, returns the normals of the faces there: none is nearer to it than the others.
    [[nodiscard]] UnitDirections upright(const PieceFeature& feature,
                                         const Double3& direction) const noexcept;

    /// Returns whether upright() would change a unit direction at a feature.
    [[nodiscard]] bool leans_over_edge(const PieceFeature& feature,
                                       const Double3& direction) const noexcept {
        return feature.kind != FeatureKind::face &&
               find_lean(feature, direction, 0, Over::flat_or_reflex).has_value() &&
               goes_on_beyond(feature, direction);
    }
    /// Returns whether a unit direction at a feature leans over an edge where the surface continues
    /// in the same plane.
    [[nodiscard]] bool leans_over_flat_edge(const PieceFeature& feature,
                                            const Double3& direction) const noexcept;

    /// Returns the source number of a triangle of the piece, the same in each query.
    [[nodiscard]] std::uint32_t source_triangle() const noexcept {
        return source_number(*model_->model, triangles_[0]);
    }
    [[nodiscard]] std::uint32_t source_vertex(std::uint32_t vertex) const noexcept {
        const auto source = model_->model->source().vertex;
        return source.empty() ? vertex : source[vertex];
    }
    /// Returns the feature with source numbers.
    [[nodiscard]] ContactFeature in_source(const PieceFeature& feature) const noexcept;

private:
    /// The maximum number of blocks of a hull that this object moves itself. Corners that were
    /// moved once are scanned eight at a time, and each is queried many times.
    static constexpr std::size_t kMostPlaced = 8;

    [[nodiscard]] bool is_placed() const noexcept {
        return placed_points_.count > 0;
    }
    void place(std::uint32_t piece, PlacedHull* large) noexcept;
    void place_into(std::span<format::HullBlock> blocks) const noexcept;
    void set_face_normals() const noexcept;
    /// Returns a triangle as moved. `i` is its place in triangles(), or not below their count.
    [[nodiscard]] PlacedTriangle placed(std::size_t i, std::uint32_t triangle) const noexcept {
        if (i < placed_triangles_count_) return placed_triangle_[i];
        const Corners at = model_->corners(triangle);
        return {at, unit_normal(at)};
    }
    [[nodiscard]] bool is_large() const noexcept {
        return triangles_.size() > kMostPlacedTriangles;
    }
    static constexpr std::size_t kMostInFan = 64;  ///< with more, all triangles are visited
    using Fan = std::array<std::uint32_t, kMostInFan>;
    /// Returns some triangles of the piece, among them all that have the vertex. Those of a small
    /// piece are all its triangles. Those of a large one have it and are put into `room`, if they
    /// fit.
    [[nodiscard]] std::span<const std::uint32_t> triangles_around(std::uint32_t vertex,
                                                                  Fan& room) const noexcept;
    /// Returns some triangles of the piece, among them all that face a unit direction squarely. For
    /// a large hull these are the few that may, in `room`.
    [[nodiscard]] std::span<const std::uint32_t> triangles_facing(const Double3& direction,
                                                                  Fan& room) const noexcept;
    /// Returns the greatest cosine of the angle between a unit direction and the normal of a
    /// triangle with the feature.
    [[nodiscard]] double facing(const PieceFeature& feature,
                                const Double3& direction) const noexcept;
    /// Returns the edge on which all vertices lie, if the mesh divides it.
    [[nodiscard]] std::optional<StraightEdge> find_divided_edge(
        const VertexSet& set) const noexcept;
    /// Returns whether an edge of a triangle at a vertex lies on an edge.
    [[nodiscard]] bool begins_with(std::uint32_t vertex, const StraightEdge& edge) const noexcept;
    /// Returns the edge of a triangle that is a part of an edge and nearest to a point.
    [[nodiscard]] std::optional<PieceFeature> find_part_of_edge(const StraightEdge& edge,
                                                                const Double3& near) const noexcept;
    [[nodiscard]] std::uint32_t nearest_triangle(const Double3& near) const noexcept;
    template <class IsTaken, class Visit>
    void each_facing(const Double3& direction, IsTaken&& is_taken, Visit&& visit) const noexcept;
    template <class Visit>
    void each_around(const PieceFeature& feature, Visit&& visit) const noexcept;
    /// The lean of a direction over an edge of a triangle: its amount, and the direction outwards
    /// over the edge. `face` is the triangle's normal on the side that the direction comes from.
    struct Lean {
        double by;
        Double3 outward;
        Double3 face;
    };
    /// The edges over which a direction may lean; the surface continues over all but convex ones.
    enum class Over : std::uint8_t { flat, flat_or_reflex, convex };
    /// Calls take(lean) for the leans above `least` over some of the edges at a feature. take() may
    /// raise `least`.
    template <class Take>
    void each_lean(const PieceFeature& feature, const Double3& direction, const double& least,
                   Over over, Take&& take) const noexcept;
    /// Returns the greatest lean above `least` over some of the edges at a feature.
    [[nodiscard]] std::optional<Lean> find_lean(const PieceFeature& feature,
                                                const Double3& direction, double least,
                                                Over over) const noexcept;
    /// Returns the normals of the faces at a feature that a unit direction leaves straight across
    /// their edges.
    [[nodiscard]] UnitDirections faces_left_across(const PieceFeature& feature,
                                                   const Double3& direction) const noexcept;
    [[nodiscard]] static bool is_among(format::EdgeConvexity edge, format::EdgeConvexity inward,
                                       Over over) noexcept;
    [[nodiscard]] bool is_inner(std::uint32_t triangle, unsigned edge) const noexcept;
    /// Returns whether the surface reaches farther along a unit direction than a feature over whose
    /// edges the direction leans. Of a vertex, other triangles there decide.
    [[nodiscard]] bool goes_on_beyond(const PieceFeature& feature,
                                      const Double3& direction) const noexcept;

    /// The most triangles that this object moves itself: 3 KiB. A piece with more is large.
    static constexpr std::size_t kMostPlacedTriangles = 32;
    enum class HasShape : std::uint8_t { unknown, no, yes };

    // In falling order of their alignment.
    std::array<format::HullBlock, kMostPlaced> placed_;
    PieceShape shape_;
    const MovedModel* model_;
    Workspace::Storage* scratch_;
    PlacedHull* large_ = nullptr;  ///< or null: the hull is not in a PlacedHull
    std::size_t placed_triangles_count_ = 0;
    bool has_reflex_edges_ = true;              ///< or is too large to know
    std::span<const std::uint32_t> triangles_;  ///< tree order
    ConvexPoints
        placed_points_;  ///< in placed_ or a PlacedHull; empty for a hull too large for both
    FeatureHull hull_;
    std::array<PlacedTriangle, kMostPlacedTriangles> placed_triangle_;
    std::uint32_t piece_;
    bool contained_;
    bool is_exact_;  ///< all triangles lie on the hull's boundary
    HasShape has_shape_ = HasShape::unknown;
};

}  // namespace cdprep
