// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Components: sets of triangles connected by shared vertices.
struct ComponentNumbers {
    std::size_t count = 0;
    std::vector<std::uint32_t> of_vertex;  ///< in the order of their lowest triangle
};

/// Numbers the components. Every vertex is used. O(n).
[[nodiscard]] ComponentNumbers number_components(const Mesh& mesh);

}  // namespace cdprep::mesh
