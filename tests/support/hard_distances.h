// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "support/exact_rational.h"
#include "support/meshes.h"

#include "cdprep/pose.h"

namespace cdprep::test {

/// Two meshes whose distance is hard to compute.
struct HardDistance {
    std::string id;  ///< number in the catalogue, X01 ... X09, and a description
    TestMesh a;
    TestMesh b;
    Placement placement = Placement::b_moves(Pose());
    std::optional<double> gap{};  ///< exact, if known by hand; else from rationals
    bool is_nested = false;       ///< as solids their distance is 0
};

/// Returns X01 to X09 of the catalogue.
[[nodiscard]] std::vector<HardDistance> hard_distances();

/// Returns the square of the distance, known by hand or from all pairs in rational numbers.
[[nodiscard]] ExactRational squared_distance_of(const HardDistance& hard);

/// X05: four tips at equal distances from a plate below.
[[nodiscard]] TestMesh four_tips();

/// X01: a cube beside the unit cube; its face x = 1 + gap is towards that cube.
[[nodiscard]] TestMesh cube_beside(double gap);

}  // namespace cdprep::test
