// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "support/meshes.h"

#include "cdprep/pairs.h"
#include "cdprep/pose.h"

namespace cdprep::test {

/// Two meshes that touch, nearly touch or nearly miss. Existing libraries report false pairs or
/// lose pairs here.
struct HardPlacement {
    std::string name;
    TestMesh a;
    TestMesh b;
    Placement placement;
    std::size_t pairs;  ///< number of overlapping pairs, touching included, by exact arithmetic
};

/// Returns placements of cubes, octahedra, sheets and needles.
[[nodiscard]] std::vector<HardPlacement> hard_placements();

/// Returns the horse on itself, and the horse snapped to a grid. `horse` is a result of
/// seed_mesh().
[[nodiscard]] std::vector<HardPlacement> hard_placements_of(const TestMesh& horse);

/// Returns the armadillo and the horse unchanged, scaled, and far from the origin. The first
/// placement is the control; the others have the same pairs.
[[nodiscard]] std::vector<HardPlacement> hard_placements_of(const TestMesh& armadillo,
                                                            const TestMesh& horse);

}  // namespace cdprep::test
