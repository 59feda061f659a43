// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "support/meshes.h"

#include "cdprep/pairs.h"
#include "cdprep/pose.h"

namespace cdprep::test {

/// How large the cases of a generator are.
enum class CaseSize : std::uint8_t {
    small,  ///< for every run of the tests
    full,   ///< as the catalogue has them, or nearly
};

/// Two meshes on which trees and walks through them go wrong, and what must be said of them.
struct HardMeshes {
    std::string id;  ///< of the catalogue, or F for failures found, with what is special
    TestMesh a;
    TestMesh b;
    Placement placement = Placement::b_moves(Pose());
    /// Known by hand; where it is not, the definition in exact numbers says (exact_pairs.h).
    std::optional<std::vector<TrianglePair>> closed{};
    std::optional<std::vector<TrianglePair>> proper{};
    /// Known by hand when there are too many pairs to list: n m.
    std::optional<std::size_t> count{};
    bool is_nested = false;  ///< nothing overlaps, and one lies in the other, which is solid
};

/// The catalogue's B01 to B15, what D05 to D07 ask of overlaps, and F01, where libraries in use
/// lose pairs (hard_placements.h). Coordinates are multiples of 2^-24 wherever that is not the
/// point, so that scaling and shifting lose nothing.
[[nodiscard]] std::vector<HardMeshes> hard_meshes(CaseSize size);

/// Triangles on the planes of octrees' cells, on faces of cones, through the centre and around
/// it; corners are whole numbers, and by symmetry the middle is 0.
[[nodiscard]] TestMesh triangles_on_cell_planes();

/// Every coordinate rounded to a multiple of `step`.
[[nodiscard]] TestMesh on_grid(TestMesh mesh, double step = 0x1p-24);

}  // namespace cdprep::test
