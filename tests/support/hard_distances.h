// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "support/exact_rational.h"
#include "support/meshes.h"

#include "cdprep/pose.h"

namespace cdprep::test {

/// Two meshes that are hard to measure.
struct HardDistance {
    std::string id;  ///< of the catalogue: X01 ... X09, with what is special
    TestMesh a;
    TestMesh b;
    Placement placement = Placement::b_moves(Pose());
    std::optional<double> gap{};  ///< exactly, where known by hand; else rationals say
    bool is_nested = false;       ///< as solids they are not apart
};

/// The catalogue's X01 to X09.
[[nodiscard]] std::vector<HardDistance> hard_distances();

/// The square of the distance: as known by hand, or of all pairs in rational numbers.
[[nodiscard]] ExactRational squared_distance_of(const HardDistance& hard);

/// X05: four tips, each as near to a plate below as the others.
[[nodiscard]] TestMesh four_tips();

/// X01: the unit cube, and one beside it whose face x = 1 + gap is towards it.
[[nodiscard]] TestMesh cube_beside(double gap);

}  // namespace cdprep::test
