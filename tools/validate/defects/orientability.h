// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/component_numbers.h"
#include "validate/defects/edge_flaws.h"

namespace cdprep::mesh {

/// A component that no choice of windings orients, and an edge of two triangles at which the
/// attempt failed. The order of the vertices determines which edge this is.
struct NonOrientable {
    std::uint32_t component;
    std::uint32_t first_triangle;  ///< of that edge
    std::uint32_t second_triangle;
};

/// Returns the non-orientable components, in ascending order. Only edges of exactly two
/// triangles matter. O(n) for the components with inconsistent edges; the others are already
/// oriented.
[[nodiscard]] std::vector<NonOrientable> find_non_orientable(const Stars& stars,
                                                             const ComponentNumbers& components,
                                                             const EdgeFlaws& flaws);

}  // namespace cdprep::mesh
