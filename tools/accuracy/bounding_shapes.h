// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "cdprep/format/geometry.h"
#include "cdprep/pose.h"
#include "mesh/mesh.h"

namespace cdprep::study {

/// A sphere that contains all vertices, and so all triangles. Built in double, rounded outwards.
struct BoundingSphere {
    Double3 centre{};
    double radius = 0;
};

/// A box along its own axes. An axis-aligned box has the axes x, y, z.
struct BoundingBox {
    Double3 centre{};
    std::array<Double3, 3> axis = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Double3 half{};
};

/// A polytope of 26 faces, perpendicular to 13 directions: the axes, the cube's diagonals, and its
/// faces' diagonals (26-DOP; Klosowski and others 1998).
struct BoundingDop {
    static constexpr std::size_t kDirections = 13;
    Double3 centre{};
    std::array<double, kDirections> lower{};  ///< from the centre, times the direction's length
    std::array<double, kDirections> upper{};
    std::vector<Double3> corners;  ///< relative to the centre; their hull is the polytope
};

/// Returns nearly the smallest bounding sphere, by 100 steps of Badoiu and Clarkson (2003). O(n).
[[nodiscard]] BoundingSphere bounding_sphere(const mesh::Mesh& mesh);
[[nodiscard]] BoundingBox aligned_box(const mesh::Mesh& mesh);
[[nodiscard]] BoundingBox oriented_box(const mesh::Mesh& mesh);
/// Returns the 26-DOP around the mesh. O(n).
[[nodiscard]] BoundingDop bounding_dop(const mesh::Mesh& mesh);

/// Returns whether A and the moved B may have a common point. False is certain: lengths get a slack
/// of kSlack times the size of the numbers. It covers rounding and rotations that are not exactly
/// orthogonal.
[[nodiscard]] bool may_touch(const BoundingSphere& a, const BoundingSphere& b,
                             const Pose& a_from_b) noexcept;

/// The same, for the box of A and the axis-aligned box around B's moved box: tests three axes.
[[nodiscard]] bool may_touch_aligned(const BoundingBox& a, const BoundingBox& b,
                                     const Pose& a_from_b) noexcept;

/// The same, by the fifteen separating axes of two boxes.
[[nodiscard]] bool may_touch(const BoundingBox& a, const BoundingBox& b,
                             const Pose& a_from_b) noexcept;

/// The same, by the 13 directions of each polytope and the extent of the other's corners along
/// them. These are not all possible separating axes of such polytopes.
[[nodiscard]] bool may_touch(const BoundingDop& a, const BoundingDop& b,
                             const Pose& a_from_b) noexcept;

/// The slack relative to the largest number. The error of rotations may be 1e-12
/// (Pose::kRotationTolerance).
inline constexpr double kSlack = 1e-11;

}  // namespace cdprep::study
