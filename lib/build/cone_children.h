// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "cone_place.h"

namespace cdprep::build {

inline constexpr std::uint32_t kRootKey = 1;  ///< of all directions: its children are the octants

/// Of each corner of a triangle (cone_place.h).
using InnerCones = std::array<std::uint32_t, 3>;

/// A triangle that is handed down a tetra-tree.
struct PlacedTriangle {
    Corners corners;
    SeenTriangle seen;
    InnerCones inner_cones;
};

/// The children of one cone, and which of them a triangle touches. Works out what it
/// needs when it is first asked for.
class ConeChildren {
public:
    /// `key` is a cone's above `level`, or kRootKey; inner cones are sought down to `level`.
    ConeChildren(std::uint32_t key, std::uint32_t level) noexcept;

    /// Returns the same as touched_by(), or 0 where cones of the corners do not tell.
    [[nodiscard]] std::uint32_t told_by(const InnerCones& cones) const noexcept;

    /// Returns a bit for each child that the triangle touches, exactly. The triangle
    /// touches the cone itself; when that is the root, none is set exactly when it holds
    /// the centre, and else it does not hold it.
    [[nodiscard]] std::uint32_t touched_by(const PlacedTriangle& t, const Double3& centre);

private:
    struct SureChildren {
        std::uint32_t mask;     ///< children that corners certainly lie in
        std::uint32_t corners;  ///< so many
    };
    [[nodiscard]] SureChildren sure_children(const InnerCones& cones) const noexcept;
    [[nodiscard]] std::uint32_t possible_children(const PlacedTriangle& t);
    [[nodiscard]] const ConeFaces& faces_of(std::uint32_t child);

    std::uint32_t key_;
    std::uint32_t bits_;   ///< of a child's key behind the cone's
    std::uint32_t below_;  ///< bits of a finest cone's key behind the child's
    std::array<std::optional<ConeFaces>, 8> faces_;
};

}  // namespace cdprep::build
