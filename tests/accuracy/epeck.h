// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "support/meshes.h"

/// CGAL's numbers that are never rounded (EPECK), where the catalogue names them as the oracle.
namespace cdprep::test {

/// A hull by CGAL.
struct EpeckHull {
    int dimension = 0;
    std::vector<Double3> corners;  ///< each once, in no order
};
/// Of at least one point.
[[nodiscard]] EpeckHull epeck_hull(const std::vector<Double3>& points);

/// How many pairs of triangles meet elsewhere than in their common corners and edges: by the
/// intersection of each two, which CGAL constructs. Corners are common where they are equal.
/// Triangles without area, or with a corner that is none, are left out.
[[nodiscard]] std::size_t epeck_meeting_pairs(const TestMesh& mesh);

}  // namespace cdprep::test
