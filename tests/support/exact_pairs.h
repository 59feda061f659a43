// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "support/meshes.h"

#include "cdprep/pairs.h"
#include "cdprep/pose.h"
#include "exact/triangle_contact.h"

namespace cdprep::test {

/// How two triangles stand, by the definition in exact numbers: whether their Minkowski
/// difference holds the origin. No predicate of the library is asked.
[[nodiscard]] TriangleContact exact_contact(const Corners& a, const Corners& b);

/// Which triangles of two meshes overlap, in the order of (a, b).
struct ExactPairs {
    std::vector<TrianglePair> closed;  ///< that have a common point
    std::vector<TrianglePair> proper;  ///< that cross, or share area in one plane
};

/// Every overlapping pair: for each two triangles whose boxes meet, exact_contact().
[[nodiscard]] ExactPairs exact_pairs(const TestMesh& a, const TestMesh& b,
                                     const Placement& placement);

}  // namespace cdprep::test
