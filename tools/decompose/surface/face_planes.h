// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

using format::Double3;

/// The planes of a mesh's triangles, and which vertices are how far above them. The mesh
/// must outlive them.
class FacePlanes {
public:
    /// `tolerance` in model units, 0 or more.
    FacePlanes(const mesh::Mesh& mesh, double tolerance, ParallelFor parallel_for);

    /// True when the vertex is known to be at most the tolerance above the plane; with a
    /// tolerance of 0 exactly when it is not above. Every vertex is admitted by a triangle
    /// without area. Heights beyond the filter are decided exactly at 0 and against the
    /// vertex otherwise: what is admitted is proved, what is refused may be 1 part in 10^9
    /// below the tolerance.
    [[nodiscard]] bool admits(std::uint32_t triangle, std::uint32_t vertex) const {
        const Plane& plane = planes_[triangle];
        const double height = raw_height(plane, mesh_.positions[vertex]);
        if (height <= plane.reach) return true;
        return height <= plane.doubt && admits_exactly(triangle, vertex);
    }

    /// Points side by side, and the vertices that they are.
    struct Points {
        std::vector<double> x, y, z;
        std::vector<std::uint32_t> vertex;
    };
    void gather(std::span<const std::uint32_t> vertices, Points& points) const;

    /// True when admits() is for all of them.
    [[nodiscard]] bool admits_all(std::uint32_t triangle, const Points& points) const;

    /// Returns an upper bound of how far one of them is above a triangle's plane; 0 exactly
    /// when none is.
    [[nodiscard]] double height_bound(std::uint32_t triangle, const Points& points) const;

private:
    /// height * |normal|, rounded: off by at most `doubt`.
    struct alignas(64) Plane {
        Double3 normal;
        Double3 at;
        double doubt;  ///< infinite where rounding has no bound
        double reach;  ///< what is at most this is at most the tolerance above
    };
    [[nodiscard]] static double raw_height(const Plane& plane, const Double3& p) {
        return plane.normal.x * (p.x - plane.at.x) + plane.normal.y * (p.y - plane.at.y) +
               plane.normal.z * (p.z - plane.at.z);
    }
    [[nodiscard]] bool admits_exactly(std::uint32_t triangle, std::uint32_t vertex) const;
    [[nodiscard]] Plane plane_of(std::uint32_t triangle, const Double3& extent) const;
    /// A lower bound of the true |normal|.
    [[nodiscard]] double least_length(std::uint32_t triangle) const;

    const mesh::Mesh& mesh_;
    double tolerance_;
    std::vector<Plane> planes_;
};

}  // namespace cdprep::convex
