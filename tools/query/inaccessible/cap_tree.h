// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"
#include "mesh/point_tree.h"

namespace cdprep::mesh {

/// The bounds of a triangle seen from a centre: a circle of directions, and two distances.
struct Cap {
    Double3 middle;  ///< unit length
    double cosine;   ///< of the circle's radius; below -1: all directions
    double sine;
    double radius;  ///< straight-line distance from `middle` to the circle
    double nearest;
    double farthest;
};

/// Finds the triangles that may occlude a triangle along rays towards a centre, by their caps.
class CapTree {
public:
    /// `triangles` index `positions`. O(n log n).
    CapTree(const Double3& centre, std::span<const Double3> positions,
            std::span<const Triangle> triangles, ParallelFor parallel_for = serial_for);

    /// Sets `others` to the triangles with a point that may lie beyond a point of `triangle` in the
    /// same direction. The list is in no order, may contain more triangles, and never contains
    /// `triangle`. Fast if there are few others. Any number of threads may call it.
    void find_others(std::uint32_t triangle, std::vector<std::uint32_t>& others) const;

private:
    /// Triangles whose caps have about the same radius.
    struct Class {
        double radius = 0;  ///< of the largest cap
        std::vector<std::uint32_t> triangles;
        PointTree middles{{}};
    };

    std::vector<Cap> caps_;  ///< by triangle
    std::vector<Class> classes_;
    std::vector<std::uint32_t> everywhere_;  ///< triangles with caps of all directions
};

}  // namespace cdprep::mesh
