// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "mesh/half_edges.h"

namespace cdprep::mesh {

/// Sorts triangles that share an edge by their angle around it, exactly.
class AroundEdge {
public:
    /// Angles are counted from the first triangle with area among `uses`.
    AroundEdge(std::span<const Double3> positions, std::span<const Triangle> triangles,
               std::span<const HalfEdge> uses);
    /// Angles are counted from `reference`, a point that is not in line with the edge.
    AroundEdge(std::span<const Double3> positions, std::span<const Triangle> triangles,
               HalfEdge use, const Double3& reference);

    /// By ascending angle, seen from the upper vertex of the edge, counter-clockwise; of
    /// one angle, those that close a wedge of solid before those that open one: two sides
    /// of a sheet are no wedge.
    [[nodiscard]] std::vector<HalfEdge> sorted(std::span<const HalfEdge> uses) const;

    /// With rising angle, the solid begins at a half-edge from the upper vertex.
    [[nodiscard]] bool opens(HalfEdge h) const;

private:
    /// 0: the angle of the reference, or no angle at all; 1: less than half a turn from
    /// it; 2: half a turn; 3: more.
    [[nodiscard]] int sector(HalfEdge h) const;
    [[nodiscard]] const Double3& apex(HalfEdge h) const;
    bool refer_to(const Double3& p);

    std::span<const Double3> positions_;
    std::span<const Triangle> triangles_;
    std::uint32_t lower_;
    std::uint32_t upper_;
    Double3 reference_{};
    int plane_ = 3;  ///< coordinate plane in which the reference turns; 3: there is none
    int turn_ = 0;   ///< and which way it turns there
};

}  // namespace cdprep::mesh
