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

/// A direction of length 1 up to rounding; 0, 0, 0 of no direction.
inline Double3 unit(const Double3& d) noexcept {
    const double most = largest_of(d);
    if (!(most > 0)) return {0, 0, 0};
    const Double3 scaled = {d.x / most, d.y / most, d.z / most};
    return (1 / std::sqrt(dot(scaled, scaled))) * scaled;
}

/// The way that a triangle faces; 0, 0, 0 of one without area.
inline Double3 unit_normal(const Corners& t) noexcept {
    return unit(cross(unit(t[1] - t[0]), unit(t[2] - t[0])));
}

/// A feature by its place in the tree order.
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

/// A piece of one of the two models of a question.
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
    /// The corners of the hull, before they are moved; of a triangle.
    [[nodiscard]] const ConvexPoints& points() const noexcept {
        return hull_.points;
    }
    [[nodiscard]] ConvexPoints points_of(std::uint32_t triangle) const noexcept;
    /// The hull where it is. Valid as long as this.
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

    /// The feature that one to three vertices span, if a triangle of the piece has them all: of
    /// several the first.
    [[nodiscard]] std::optional<PieceFeature> find_feature(const VertexSet& set) const noexcept;

    /// The feature that is farthest along a unit direction, near a point of the hull's border.
    [[nodiscard]] PieceFeature feature_along(const Double3& direction,
                                             const Double3& near) const noexcept;

    /// Whether the way out of the piece along a unit direction leads away from the solid: a
    /// triangle with the feature faces it.
    [[nodiscard]] bool leads_out(const PieceFeature& feature,
                                 const Double3& direction) const noexcept {
        return facing(feature, direction) > 0;
    }
    /// Whether what is there in a unit direction is in the solid, clearly: it sees the backs of all
    /// triangles with the feature.
    [[nodiscard]] bool is_seen_from_behind(const PieceFeature& feature,
                                           const Double3& direction) const noexcept;

    /// A unit direction at a feature, made not to lean over edges where the surface goes on;
    /// nothing when it does not.
    [[nodiscard]] std::optional<Double3> upright(const PieceFeature& feature,
                                                 const Double3& direction) const noexcept;

    /// In the numbering of the imported file.
    [[nodiscard]] ContactFeature in_source(const PieceFeature& feature) const noexcept;

private:
    /// Hulls of so many blocks at most are moved once and for all, and scanned eight corners at a
    /// time: most pieces have few corners, and each is asked for many times.
    static constexpr std::size_t kMostPlaced = 8;

    [[nodiscard]] bool is_placed() const noexcept {
        return placed_points_.count > 0;
    }
    void place() noexcept;
    [[nodiscard]] std::optional<PieceFeature> find_face(const Double3& direction,
                                                        const Double3& near) const noexcept;
    /// How much a triangle with the feature faces a unit direction, at most: a cosine.
    [[nodiscard]] double facing(const PieceFeature& feature,
                                const Double3& direction) const noexcept;
    [[nodiscard]] std::uint32_t nearest_triangle(const Double3& near) const noexcept;
    template <class Visit>
    void each_around(const PieceFeature& feature, Visit&& visit) const noexcept;
    /// By how much a direction leans over an edge of a triangle, which way that is, and how the
    /// triangle faces where the direction comes from.
    struct Lean {
        double by;
        Double3 outward;
        Double3 face;
    };
    /// The greatest above `least`, of the edges at a feature where the surface goes on.
    [[nodiscard]] std::optional<Lean> find_lean(const PieceFeature& feature,
                                                const Double3& direction,
                                                double least) const noexcept;
    [[nodiscard]] bool is_inner(std::uint32_t triangle, unsigned edge) const noexcept;

    const MovedModel* model_;
    std::span<const std::uint32_t> triangles_;  ///< tree order
    bool contained_;
    FeatureHull hull_;
    ConvexPoints placed_points_;  ///< in placed_; none of a hull that is too large
    std::array<format::HullBlock, kMostPlaced> placed_;
};

}  // namespace cdprep
