// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"
#include "mesh/point_tree.h"

namespace cdprep::mesh {

/// What bounds a triangle as seen from a centre: a circle of directions, and distances.
struct Cap {
    Double3 middle;  ///< unit length
    double cosine;   ///< of the circle's radius; below -1: all directions
    double sine;
    double radius;  ///< of the circle, from `middle` straight to a point of it
    double nearest;
    double farthest;
};

/// Which triangles may hide which from a centre's far side, by what bounds them.
class CapTree {
public:
    /// `triangles` index `positions`. O(n log n).
    CapTree(const Double3& centre, std::span<const Double3> positions,
            std::span<const Triangle> triangles, ParallelFor parallel_for = serial_for);

    /// Sets `others` to all triangles, but for itself, of which some point may lie beyond
    /// one of the triangle in a direction of both, and perhaps more; no order. Fast for
    /// triangles of few others. Any number of threads.
    void find_others(std::uint32_t triangle, std::vector<std::uint32_t>& others) const;

private:
    /// Those of about one size.
    struct Class {
        double radius = 0;  ///< of the largest
        std::vector<std::uint32_t> triangles;
        PointTree middles{{}};
    };

    std::vector<Cap> caps_;  ///< by triangle
    std::vector<Class> classes_;
    std::vector<std::uint32_t> everywhere_;  ///< those of all directions
};

}  // namespace cdprep::mesh
