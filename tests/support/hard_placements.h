// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "support/meshes.h"

#include "cdprep/pairs.h"
#include "cdprep/pose.h"

namespace cdprep::test {

/// Two meshes that touch, nearly touch or nearly miss, where libraries in use
/// report pairs that are none or lose pairs.
struct HardPlacement {
    std::string name;
    TestMesh a;
    TestMesh b;
    Placement placement;
    std::size_t pairs;  ///< that overlap, touching included: by exact arithmetic
};

/// Cubes, octahedra, sheets and needles.
[[nodiscard]] std::vector<HardPlacement> hard_placements();

/// The horse on itself and snapped to a grid; `horse` as seed_mesh() gives it.
[[nodiscard]] std::vector<HardPlacement> hard_placements_of(const TestMesh& horse);

/// The armadillo and the horse as they come, scaled, and far from the origin: the
/// first is the control, the others have the same pairs.
[[nodiscard]] std::vector<HardPlacement> hard_placements_of(const TestMesh& armadillo,
                                                            const TestMesh& horse);

}  // namespace cdprep::test
