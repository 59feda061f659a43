// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

using format::Double3;

/// The planes of a mesh's triangles, and the heights of vertices above them. The mesh must outlive
/// this.
class FacePlanes {
public:
    /// `tolerance` is in model units, 0 or more.
    FacePlanes(const mesh::Mesh& mesh, double tolerance, ParallelFor parallel_for);

    /// Returns true if the vertex is proved to be at most the tolerance above the plane. With a
    /// tolerance of 0 the result is exact: true if and only if the vertex is not above. A triangle
    /// without area admits every vertex. If the filter does not decide, an exact test against the
    /// plane itself does: it admits only a vertex that is not above. So with a tolerance above 0, a
    /// refused vertex may be up to 1 part in 10^9 below the tolerance.
    [[nodiscard]] bool admits(std::uint32_t triangle, std::uint32_t vertex) const {
        const Plane& plane = planes_[triangle];
        const double height = raw_height(plane, mesh_.positions[vertex]);
        if (height <= plane.reach) return true;
        return height <= plane.doubt && admits_exactly(triangle, vertex);
    }

    /// Points stored by coordinate, and their vertex numbers.
    struct Points {
        std::vector<double> x, y, z;
        std::vector<std::uint32_t> vertex;
    };
    void gather(std::span<const std::uint32_t> vertices, Points& points) const;

    /// Returns true if admits() is true for all points.
    [[nodiscard]] bool admits_all(std::uint32_t triangle, const Points& points) const;

    /// Returns an upper bound of the points' heights above a triangle's plane. It is 0 if and only
    /// if no point is above.
    [[nodiscard]] double height_bound(std::uint32_t triangle, const Points& points) const;

private:
    /// A plane for rounded values of height * |normal|, which are off by at most `doubt`.
    struct alignas(64) Plane {
        Double3 normal;
        Double3 at;
        double doubt;  ///< infinite where rounding has no bound
        double reach;  ///< a value up to this proves a height within the tolerance
    };
    [[nodiscard]] static double raw_height(const Plane& plane, const Double3& p) {
        return plane.normal.x * (p.x - plane.at.x) + plane.normal.y * (p.y - plane.at.y) +
               plane.normal.z * (p.z - plane.at.z);
    }
    [[nodiscard]] bool admits_exactly(std::uint32_t triangle, std::uint32_t vertex) const;
    [[nodiscard]] Plane plane_of(std::uint32_t triangle, const Double3& extent) const;
    /// Returns a lower bound of the true |normal|.
    [[nodiscard]] double least_length(std::uint32_t triangle) const;

    const mesh::Mesh& mesh_;
    double tolerance_;
    std::vector<Plane> planes_;
};

}  // namespace cdprep::convex
