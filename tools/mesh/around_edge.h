// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "mesh/half_edges.h"

namespace cdprep::mesh {

/// Sorts triangles that share an edge by their angle around it, exactly.
class AroundEdge {
public:
    /// Measures angles from the first triangle with area among `uses`.
    AroundEdge(std::span<const Double3> positions, std::span<const Triangle> triangles,
               std::span<const HalfEdge> uses);
    /// Measures angles from `reference`, a point that is not collinear with the edge.
    AroundEdge(std::span<const Double3> positions, std::span<const Triangle> triangles,
               HalfEdge use, const Double3& reference);

    /// Returns the uses by ascending angle, counter-clockwise as seen from the upper vertex of
    /// the edge. At equal angles, those that close a wedge of solid come before those that open
    /// one: two sides of a sheet are no wedge.
    [[nodiscard]] std::vector<HalfEdge> sorted(std::span<const HalfEdge> uses) const;

    /// Returns whether the solid begins at this half-edge, by ascending angle: it starts at the
    /// upper vertex.
    [[nodiscard]] bool opens(HalfEdge h) const;

private:
    /// Returns 0 for the angle of the reference, or without an angle. Returns 1 for less than
    /// half a turn from it, 2 for half a turn, 3 for more.
    [[nodiscard]] int sector(HalfEdge h) const;
    [[nodiscard]] const Double3& apex(HalfEdge h) const;
    bool refer_to(const Double3& p);

    std::span<const Double3> positions_;
    std::span<const Triangle> triangles_;
    std::uint32_t lower_;
    std::uint32_t upper_;
    Double3 reference_{};
    int plane_ = 3;  ///< coordinate plane in which the reference turns; 3: none
    int turn_ = 0;   ///< the direction of that turn
};

}  // namespace cdprep::mesh
