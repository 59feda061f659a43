// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "cells/cone_place.h"

namespace cdprep::build {

inline constexpr std::uint32_t kRootKey = 1;  ///< of all directions: its children are the octants

/// Where a vertex is, seen from the centre.
struct PlacedVertex {
    std::array<float, 3> at;   ///< on the octahedron's face, by axis, rounded; sum 1
    std::uint32_t inner_cone;  ///< cone_place.h
};

/// What is handed down a tetra-tree.
struct TetraInput {
    std::span<const format::Double3> positions;
    std::span<const format::Triangle> triangles;
    std::span<const PlacedVertex> places;  ///< of positions
    Double3 centre;
    double scale;         ///< a power of two that brings the model near 1
    std::uint32_t level;  ///< down to which inner cones were sought

    [[nodiscard]] Corners corners(std::uint32_t triangle) const noexcept {
        const auto& v = triangles[triangle].vertex;
        return {positions[v[0]], positions[v[1]], positions[v[2]]};
    }
    [[nodiscard]] SeenTriangle seen(std::uint32_t triangle) const noexcept {
        return seen_triangle(centre, corners(triangle), scale);
    }
};

/// The children of one cone, and which of them a triangle touches.
class ConeChildren {
public:
    /// `key` is a cone's above the input's level, or kRootKey.
    ConeChildren(const TetraInput& input, std::uint32_t key) noexcept;

    /// Returns a bit for each child that the triangle touches, exactly. The triangle touches
    /// the cone itself; when that is the root, none is set exactly when it holds the centre,
    /// and else it does not hold it. `in_octant` says that corners have inner cones in one
    /// octant; may be false all the same.
    [[nodiscard]] std::uint32_t touched_by(std::uint32_t triangle, bool in_octant);

private:
    using Places = std::array<const PlacedVertex*, 3>;

    [[nodiscard]] std::uint32_t sure_children(const Places& at) const noexcept;
    [[nodiscard]] std::uint32_t possible_by_places(const Places& at) const noexcept;
    [[nodiscard]] std::uint32_t possible_by_values(const SeenTriangle& t) const noexcept;
    [[nodiscard]] std::uint32_t touched_among(std::uint32_t triangle, std::uint32_t children);

    const TetraInput& input_;
    std::uint32_t key_;
    std::uint32_t bits_;   ///< of a child's key behind the cone's
    std::uint32_t below_;  ///< bits of a finest cone's key behind the child's
    ConeFaces middle_{};   ///< of the middle child; of the root not used
    /// By axis: the middle child's face, and the child behind it.
    struct Border {
        float above;  ///< of what is less, all is certainly below the plane
        float below;
        std::uint32_t child;  ///< its bit
    };
    std::array<Border, 3> borders_{};
    std::array<std::optional<ConeFaces>, 8> faces_;  ///< once asked for
};

}  // namespace cdprep::build
