// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/component_numbers.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// A component that lies in another.
struct Nested {
    std::uint32_t inner;
    std::uint32_t outer;
    int winding;  ///< of `outer` around `inner`, not 0
};

/// Finds which balanced components lie in which: the winding number of the one around the
/// lowest vertex of the other that is not on its surface. Sorted by inner, then outer.
/// Those that cross are looked at no closer. Exact.
///
/// One ray from each component along x. O(n log c) for c components, and O(pairs of a
/// component within another's box and a triangle of that which its ray may meet): k shells,
/// each in the next, are k (k - 1) / 2 pairs.
[[nodiscard]] std::vector<Nested> find_nested(const Mesh& mesh, const ComponentNumbers& components,
                                              const std::vector<bool>& balanced);

}  // namespace cdprep::mesh
