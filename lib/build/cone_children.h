// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "cone_place.h"

namespace cdprep::build {

inline constexpr std::uint32_t kRootKey = 1;  ///< of all directions: its children are the octants

/// A triangle that is handed down a tetra-tree.
struct PlacedTriangle {
    Corners corners;
    SeenTriangle seen;
    std::array<std::uint32_t, 3> inner_cone;  ///< of each corner (cone_place.h)
};

/// The children of one cone, and which of them a triangle touches. Works out what it
/// needs when it is first asked for.
class ConeChildren {
public:
    /// `key` is a cone's, or kRootKey.
    explicit ConeChildren(std::uint32_t key) noexcept : key_(key) {}

    /// Returns a bit for each child that the triangle touches, exactly. The triangle
    /// touches the cone itself; when that is the root, none is set exactly when it holds
    /// the centre, and else it does not hold it.
    [[nodiscard]] std::uint32_t touched_by(const PlacedTriangle& t, const Double3& centre);

private:
    [[nodiscard]] std::uint32_t sure_children(const PlacedTriangle& t) const noexcept;
    [[nodiscard]] std::uint32_t possible_children(const PlacedTriangle& t);
    [[nodiscard]] const ConeFaces& faces_of(std::uint32_t child);

    std::uint32_t key_;
    std::array<std::optional<ConeFaces>, 8> faces_;
};

}  // namespace cdprep::build
