// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::convex {

using format::Double3;

struct Box {
    Double3 lower;
    Double3 upper;

    void take_in(const Double3& p) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    /// Returns true if the box, flat or not, has a point in the interior of `solid`.
    [[nodiscard]] bool reaches_into(const Box& solid) const {
        return lower.x < solid.upper.x && upper.x > solid.lower.x && lower.y < solid.upper.y &&
               upper.y > solid.lower.y && lower.z < solid.upper.z && upper.z > solid.lower.z;
    }
};

/// Returns the box of some points. `points` must not be empty.
[[nodiscard]] inline Box box_of(std::span<const Double3> points) {
    Box box{points[0], points[0]};
    for (const Double3& p : points) box.take_in(p);
    return box;
}

/// Boxes over eight triangles each, over eight such boxes each, and so on. The mesh's triangles
/// must be in tree order. Exact: boxes are in the mesh's own coordinates.
class BoxPyramid {
public:
    explicit BoxPyramid(const mesh::Mesh& mesh);

    /// Calls visit(triangle) for each triangle whose box reaches into `box`, in order. Stops and
    /// returns false when visit() returns false.
    template <class Visit>
    bool visit(const Box& box, Visit visit) const {
        return levels_.empty() || visit_below(levels_.size() - 1, 0, box, visit);
    }

private:
    static constexpr std::size_t kWidth = 8;  ///< boxes below one: changes no result

    template <class Visit>
    bool visit_below(std::size_t level, std::size_t at, const Box& box, Visit& visit) const {
        if (!levels_[level][at].reaches_into(box)) return true;
        const std::size_t below = level == 0 ? mesh_.triangles.size() : levels_[level - 1].size();
        const std::size_t last = std::min((at + 1) * kWidth, below);
        for (std::size_t i = at * kWidth; i < last; ++i) {
            if (level > 0) {
                if (!visit_below(level - 1, i, box, visit)) return false;
            } else if (box_of_triangle(i).reaches_into(box)) {
                if (!visit(static_cast<std::uint32_t>(i))) return false;
            }
        }
        return true;
    }
    [[nodiscard]] Box box_of_triangle(std::size_t triangle) const {
        const auto& v = mesh_.triangles[triangle].vertex;
        Box box{mesh_.positions[v[0]], mesh_.positions[v[0]]};
        box.take_in(mesh_.positions[v[1]]);
        box.take_in(mesh_.positions[v[2]]);
        return box;
    }

    const mesh::Mesh& mesh_;
    std::vector<std::vector<Box>> levels_;  ///< the last level has one box
};

}  // namespace cdprep::convex
