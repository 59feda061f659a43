// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "support/meshes.h"

namespace cdprep::test {

// Closed solids that are not convex, and one that is.

/// A polygon in the plane z = 0, counter-clockwise, drawn out to z = 1; `triangles` fill it.
[[nodiscard]] TestMesh prism(const std::vector<std::array<double, 2>>& outline,
                             const std::vector<std::array<std::uint32_t, 3>>& triangles);
/// Three unit cubes in a row with a corner: the notch is where x and y are above 1.
[[nodiscard]] TestMesh l_prism();
[[nodiscard]] TestMesh u_prism();
[[nodiscard]] TestMesh plus_prism();

/// A body of revolution with two waists.
[[nodiscard]] TestMesh star();
/// Square tubes along a helix and, closed, along a knot.
[[nodiscard]] TestMesh spiral_stair();
[[nodiscard]] TestMesh trefoil_tube();

/// [0, n] x [0, m] x [-1, 0], of whose sides the upper and the lower are grids of n x m squares.
[[nodiscard]] TestMesh box_with_a_fine_side(int n, int m);

}  // namespace cdprep::test
