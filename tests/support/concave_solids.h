// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "support/meshes.h"

namespace cdprep::test {

// Closed solids that are not convex, and one that is.

/// Returns a polygon in the plane z = 0, extruded to z = 1. The outline is counter-clockwise, and
/// `triangles` fill it.
[[nodiscard]] TestMesh prism(const std::vector<std::array<double, 2>>& outline,
                             const std::vector<std::array<std::uint32_t, 3>>& triangles);
/// Returns three unit cubes in an L shape. The notch is where x and y are above 1.
[[nodiscard]] TestMesh l_prism();
[[nodiscard]] TestMesh u_prism();
[[nodiscard]] TestMesh plus_prism();

/// Returns a body of revolution with two waists.
[[nodiscard]] TestMesh star();
/// Return square tubes: one along a helix, and a closed one along a knot.
[[nodiscard]] TestMesh spiral_stair();
[[nodiscard]] TestMesh trefoil_tube();

/// Returns [0, n] x [0, m] x [-1, 0]. Its upper and lower sides are grids of n x m squares.
[[nodiscard]] TestMesh box_with_a_fine_side(int n, int m);

}  // namespace cdprep::test
