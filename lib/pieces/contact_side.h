// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "cdprep/advanced/closest_features.h"
#include "cdprep/contacts.h"
#include "core/moved_model.h"
#include "hull/moved_hull.h"

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
    return unit(cross(unit(t[1] - t[0]), unit(t[2] - t[0])));
}

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

/// A piece of one of the two models of a query.
class ContactSide {
public:
    ContactSide(const MovedModel& model, std::uint32_t piece) noexcept;
    ContactSide(const ContactSide&) = delete;  // placed_points_ refer to placed_
    ContactSide& operator=(const ContactSide&) = delete;
    ~ContactSide() = default;

    [[nodiscard]] const MovedModel& model() const noexcept {
        return *model_;
    }
    [[nodiscard]] std::span<const std::uint32_t> triangles() const noexcept {
        return triangles_;
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
        return is_placed() ? placed_points_.point(number)
                           : model_->position(hull_.points.corners[number]);
    }
    [[nodiscard]] Double3 normal_of(std::uint32_t triangle) const noexcept {
        return unit_normal(model_->corners(triangle));
    }

    /// Returns the feature that one to three vertices span, if a triangle of the piece has them
    /// all. The first of several triangles counts.
    [[nodiscard]] std::optional<PieceFeature> find_feature(const VertexSet& set) const noexcept;

    /// Returns the feature that is farthest along a unit direction, near a point of the hull's
    /// border.
    [[nodiscard]] PieceFeature feature_along(const Double3& direction,
                                             const Double3& near) const noexcept;

    /// Returns whether the way out of the piece along a unit direction leads away from the solid: a
    /// triangle with the feature faces that direction.
    [[nodiscard]] bool leads_out(const PieceFeature& feature,
                                 const Double3& direction) const noexcept {
        return facing(feature, direction) > 0;
    }
    /// Returns whether the space in a unit direction is clearly inside the solid: the direction is
    /// behind all triangles with the feature.
    [[nodiscard]] bool is_seen_from_behind(const PieceFeature& feature,
                                           const Double3& direction) const noexcept;

    /// Returns a unit direction at a feature, changed so that it does not lean over edges where the
    /// surface continues. Returns nothing when it does not lean over any.
    [[nodiscard]] std::optional<Double3> upright(const PieceFeature& feature,
                                                 const Double3& direction) const noexcept;

    /// Returns whether a unit direction at a feature leans over an edge where the surface continues
    /// in the same plane.
    [[nodiscard]] bool leans_over_flat_edge(const PieceFeature& feature,
                                            const Double3& direction) const noexcept;

    /// Returns the feature with source numbers.
    [[nodiscard]] ContactFeature in_source(const PieceFeature& feature) const noexcept;

private:
    /// The maximum number of blocks of a hull that is moved once and scanned eight corners at a
    /// time. Most pieces have few corners, and each is queried many times.
    static constexpr std::size_t kMostPlaced = 8;

    [[nodiscard]] bool is_placed() const noexcept {
        return placed_points_.count > 0;
    }
    void place() noexcept;
    [[nodiscard]] std::optional<PieceFeature> find_face(const Double3& direction,
                                                        const Double3& near) const noexcept;
    /// Returns the greatest cosine of the angle between a unit direction and the normal of a
    /// triangle with the feature.
    [[nodiscard]] double facing(const PieceFeature& feature,
                                const Double3& direction) const noexcept;
    [[nodiscard]] std::uint32_t nearest_triangle(const Double3& near) const noexcept;
    template <class Visit>
    void each_around(const PieceFeature& feature, Visit&& visit) const noexcept;
    /// The lean of a direction over an edge of a triangle: its amount, and the direction outwards
    /// over the edge. `face` is the triangle's normal on the side that the direction comes from.
    struct Lean {
        double by;
        Double3 outward;
        Double3 face;
    };
    /// The edges over which a surface continues.
    enum class Over : std::uint8_t { flat, flat_or_reflex };
    /// Returns the greatest lean above `least` over the edges at a feature where the surface
    /// continues.
    [[nodiscard]] std::optional<Lean> find_lean(const PieceFeature& feature,
                                                const Double3& direction, double least,
                                                Over over) const noexcept;
    [[nodiscard]] bool is_inner(std::uint32_t triangle, unsigned edge) const noexcept;

    const MovedModel* model_;
    std::span<const std::uint32_t> triangles_;  ///< tree order
    bool contained_;
    FeatureHull hull_;
    ConvexPoints placed_points_;  ///< in placed_; empty for a hull that is too large
    std::array<format::HullBlock, kMostPlaced> placed_;
};

}  // namespace cdprep
