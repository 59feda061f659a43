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

/// The size of the cases of a generator.
enum class CaseSize : std::uint8_t {
    small,  ///< for every run of the tests
    full,   ///< the sizes of the catalogue, or nearly
};

/// Two meshes that are hard for trees and traversals, and the expected result.
struct HardMeshes {
    std::string id;  ///< number in the catalogue, or F for a found failure, and a description
    TestMesh a;
    TestMesh b;
    Placement placement = Placement::b_moves(Pose());
    /// Known by hand; else computed from the definition in exact numbers (exact_pairs.h).
    std::optional<std::vector<TrianglePair>> closed{};
    std::optional<std::vector<TrianglePair>> proper{};
    /// Known by hand if there are too many pairs to list: n m.
    std::optional<std::size_t> count{};
    bool is_nested = false;  ///< nothing overlaps, and one lies inside the other, which is solid
};

/// Returns B01 to B15 of the catalogue, the overlap cases of D05 to D07, and F01, in which existing
/// libraries lose pairs (hard_placements.h). Coordinates are multiples of 2^-24 unless a case is
/// about coordinates, so that scaling and shifting are exact.
[[nodiscard]] std::vector<HardMeshes> hard_meshes(CaseSize size);

/// Returns triangles on the planes of octree cells, on faces of cones, through the centre and
/// around it. Corners are whole numbers, and by symmetry the middle is 0.
[[nodiscard]] TestMesh triangles_on_cell_planes();

/// Returns the mesh with every coordinate rounded to a multiple of `step`.
[[nodiscard]] TestMesh on_grid(TestMesh mesh, double step = 0x1p-24);

}  // namespace cdprep::test
