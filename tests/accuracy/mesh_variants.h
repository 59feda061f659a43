// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "accuracy/exact_change.h"
#include "support/meshes.h"

#include "cdprep/pairs.h"
#include "cdprep/pose.h"

namespace cdprep::test {

/// A mesh whose triangles and vertices stand in another order, and which begin with another
/// corner; none is turned over.
struct Relabelled {
    TestMesh mesh;
    std::vector<std::uint32_t> was;  ///< number before, of each triangle
};

[[nodiscard]] Relabelled relabelled(const TestMesh& mesh, std::uint32_t seed);

/// Two meshes in another guise. No answer may change but by its numbers and by the scale.
struct MeshVariant {
    std::string name;
    TestMesh a;
    TestMesh b;
    Placement placement;
    ExactChange change{};
    bool is_swapped = false;             ///< a is the case's b
    std::vector<std::uint32_t> was_a{};  ///< number in the case; empty: the same
    std::vector<std::uint32_t> was_b{};

    /// The case's pairs under this variant's numbers, sorted.
    [[nodiscard]] std::vector<TrianglePair> told(const std::vector<TrianglePair>& pairs) const;
};

/// As they are placed; relabelled; swapped; as every ExactChange has them, turned and shifted by
/// their vertices and by their poses in turns; and some of all at once.
[[nodiscard]] std::vector<MeshVariant> mesh_variants(const TestMesh& a, const TestMesh& b,
                                                     const Placement& placement, bool few);

}  // namespace cdprep::test
