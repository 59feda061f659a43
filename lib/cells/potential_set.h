// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/moved_model.h"
#include "walk/walk_model.h"

namespace cdprep {

/// A model's own oriented box as one query of another model sees it: six planes that clip
/// that model's triangles, in its stored coordinates. What lies beyond one of them touches
/// no triangle in the box; the rest is the potentially colliding set.
///
/// Without the section `bounds` the root box of the hierarchy stands for it.
class PotentialSet {
public:
    /// The box is A's, the triangles are B's.
    PotentialSet(const Model& a, const Model& b, const Placement& placement) noexcept;

    /// The boxes of a node of B's hierarchy that no plane clips.
    [[nodiscard]] BoxVerdict judge(const format::BvhNode& node) const noexcept;
    /// Whether no plane clips a triangle, corners as stored.
    [[nodiscard]] bool holds(const Corners& t) const noexcept;

    /// Whether A's box clips all of B's own oriented box.
    [[nodiscard]] bool is_empty() const noexcept {
        return is_empty_;
    }

private:
    /// Points p with |normal * p + offset| <= limit.
    struct Slab {
        std::array<double, 3> normal;  ///< along B's axes
        double offset;                 ///< model units
        double limit;
        double node_offset;  ///< of frame coordinates
        double node_limit;
    };
    /// Whether a box of any axes lies beyond a plane, model units.
    [[nodiscard]] static bool clips(const Slab& slab, const format::Bounds& box) noexcept;

    std::array<Slab, 3> slab_{};
    bool is_empty_ = false;
};

}  // namespace cdprep
