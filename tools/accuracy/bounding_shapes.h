// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "cdprep/format/geometry.h"
#include "cdprep/pose.h"
#include "mesh/mesh.h"

namespace cdprep::study {

/// What all vertices lie in, and so all triangles. Built in double, rounded outwards.
struct BoundingSphere {
    Double3 centre{};
    double radius = 0;
};

/// A box along axes of its own; of an axis-aligned one they are x, y, z.
struct BoundingBox {
    Double3 centre{};
    std::array<Double3, 3> axis = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Double3 half{};
};

/// The polytope of 26 faces between the planes across 13 directions: along the axes, the cube's
/// diagonals, and its faces' diagonals (26-DOP; Klosowski and others 1998).
struct BoundingDop {
    static constexpr std::size_t kDirections = 13;
    Double3 centre{};
    std::array<double, kDirections> lower{};  ///< from the centre, times the direction's length
    std::array<double, kDirections> upper{};
    std::vector<Double3> corners;  ///< from the centre; their hull is the polytope
};

/// Nearly the least one: a hundred steps of Badoiu and Clarkson (2003). O(n).
[[nodiscard]] BoundingSphere bounding_sphere(const mesh::Mesh& mesh);
[[nodiscard]] BoundingBox aligned_box(const mesh::Mesh& mesh);
[[nodiscard]] BoundingBox oriented_box(const mesh::Mesh& mesh);
/// O(n).
[[nodiscard]] BoundingDop bounding_dop(const mesh::Mesh& mesh);

/// Whether they may have a common point when B is moved. False only where they have none for
/// certain: lengths get kSlack of what the numbers are large, for rounding and for a
/// rotation that is one but nearly.
[[nodiscard]] bool may_touch(const BoundingSphere& a, const BoundingSphere& b,
                             const Pose& a_from_b) noexcept;

/// By the box of A and the axis-aligned one around B's moved box: three axes.
[[nodiscard]] bool may_touch_aligned(const BoundingBox& a, const BoundingBox& b,
                                     const Pose& a_from_b) noexcept;

/// By the fifteen axes that part boxes.
[[nodiscard]] bool may_touch(const BoundingBox& a, const BoundingBox& b,
                             const Pose& a_from_b) noexcept;

/// By the 13 directions of each, in which the other reaches as far as its corners do: not all
/// that part such polytopes.
[[nodiscard]] bool may_touch(const BoundingDop& a, const BoundingDop& b,
                             const Pose& a_from_b) noexcept;

/// Of the largest number: rotations may be off by 1e-12 (Pose::kRotationTolerance).
inline constexpr double kSlack = 1e-11;

}  // namespace cdprep::study
