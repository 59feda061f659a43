// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/component_numbers.h"
#include "validate/defects/edge_flaws.h"

namespace cdprep::mesh {

/// A component that no choice of windings orients, and an edge of two triangles at which
/// the attempt failed: which one depends on the order of the vertices.
struct NonOrientable {
    std::uint32_t component;
    std::uint32_t first_triangle;  ///< at that edge
    std::uint32_t second_triangle;
};

/// Finds them, by ascending component. Only edges of exactly two triangles bind. O(n) for
/// the components that have inconsistent edges; the others are oriented already.
[[nodiscard]] std::vector<NonOrientable> find_non_orientable(const Stars& stars,
                                                             const ComponentNumbers& components,
                                                             const EdgeFlaws& flaws);

}  // namespace cdprep::mesh
