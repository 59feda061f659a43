// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "cells/cone_place.h"

namespace cdprep::build {

inline constexpr std::uint32_t kRootKey = 1;  ///< of all directions: its children are the octants

/// The place of a vertex as seen from the centre.
struct PlacedVertex {
    std::array<float, 3> at;   ///< on the octahedron's face, by axis, rounded; sum 1
    std::uint32_t inner_cone;  ///< cone_place.h
};

/// The data that a tetra-tree's builder passes down the levels.
struct TetraInput {
    std::span<const format::Double3> positions;
    std::span<const format::Triangle> triangles;
    std::span<const PlacedVertex> places;  ///< one per position
    Double3 centre;
    double scale;         ///< a power of two that brings the model near 1
    std::uint32_t level;  ///< the finest level of inner cones

    [[nodiscard]] Corners corners(std::uint32_t triangle) const noexcept {
        const auto& v = triangles[triangle].vertex;
        return {positions[v[0]], positions[v[1]], positions[v[2]]};
    }
    [[nodiscard]] SeenTriangle seen(std::uint32_t triangle) const noexcept {
        return seen_triangle(centre, corners(triangle), scale);
    }
};

/// The children of one cone, with a test for which of them a triangle touches.
class ConeChildren {
public:
    /// `key` is that of a cone above the input's level, or kRootKey.
    ConeChildren(const TetraInput& input, std::uint32_t key) noexcept;

    /// Returns a bit for each child that the triangle touches, exactly. The triangle must touch the
    /// cone itself. For the root, no bit is set exactly when the triangle holds the centre. For any
    /// other cone, the triangle must not hold the centre. `in_octant` may be true only if the
    /// corners have inner cones in one octant; it may always be false.
    [[nodiscard]] std::uint32_t touched_by(std::uint32_t triangle, bool in_octant);

private:
    using Places = std::array<const PlacedVertex*, 3>;

    [[nodiscard]] std::uint32_t sure_children(const Places& at) const noexcept;
    [[nodiscard]] std::uint32_t possible_by_places(const Places& at) const noexcept;
    [[nodiscard]] std::uint32_t possible_by_values(const SeenTriangle& t) const noexcept;
    [[nodiscard]] std::uint32_t touched_among(std::uint32_t triangle, std::uint32_t children);

    const TetraInput& input_;
    std::uint32_t key_;
    std::uint32_t bits_;   ///< length of a child's key after the cone's
    std::uint32_t below_;  ///< length of a finest cone's key after the child's
    ConeFaces middle_{};   ///< of the middle child; not used for the root
    /// For each axis: the face of the middle child, and the child behind it.
    struct Border {
        float above;  ///< places less than this are certainly below the plane
        float below;
        std::uint32_t child;  ///< its bit
    };
    std::array<Border, 3> borders_{};
    std::array<std::optional<ConeFaces>, 8> faces_;  ///< computed on first use
};

}  // namespace cdprep::build
