// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "support/meshes.h"

#include "cdprep/pairs.h"
#include "cdprep/pose.h"
#include "exact/triangle_contact.h"

namespace cdprep::test {

/// Returns the contact of two triangles, by the definition in exact numbers: does their Minkowski
/// difference contain the origin? Calls no predicate of the library.
[[nodiscard]] TriangleContact exact_contact(const Corners& a, const Corners& b);

/// The overlapping triangles of two meshes, in the order of (a, b).
struct ExactPairs {
    std::vector<TrianglePair> closed;  ///< pairs with a common point
    std::vector<TrianglePair> proper;  ///< pairs that cross, or share area in one plane
};

/// Returns every overlapping pair. Calls exact_contact() for each two triangles whose boxes meet.
[[nodiscard]] ExactPairs exact_pairs(const TestMesh& a, const TestMesh& b,
                                     const Placement& placement);

}  // namespace cdprep::test
