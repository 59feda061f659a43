// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/component_numbers.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// A component that lies inside another.
struct Nested {
    std::uint32_t inner;
    std::uint32_t outer;
    int winding;  ///< of `outer` around `inner`, not 0
};

/// Returns the pairs of balanced components with one inside the other, sorted by inner, then
/// outer. The test is the winding number of the outer one around a vertex of the inner one. That
/// vertex is the lowest one off the outer one's surface. The test ignores crossings of the two.
/// Exact.
///
/// Casts one ray along x from each component. Takes O(n log c) for c components, plus O(pairs).
/// A pair is a component within another one's box, and a triangle of the other that its ray may
/// meet. k shells, each inside the next, are k (k - 1) / 2 pairs.
[[nodiscard]] std::vector<Nested> find_nested(const Mesh& mesh, const ComponentNumbers& components,
                                              const std::vector<bool>& balanced);

}  // namespace cdprep::mesh
