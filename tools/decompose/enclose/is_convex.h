// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "hull/convex_hull.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// Returns true if these triangles of a mesh are the surface of their hull. Exact. Three conditions
/// decide. No edge is reflex. The oriented uses of every edge cancel. Triangles and hull enclose
/// exactly the same volume. A surface turned inside out counts too.
[[nodiscard]] bool is_convex(const mesh::Mesh& mesh, std::span<const std::uint32_t> triangles,
                             const ConvexHull& hull);

}  // namespace cdprep::convex
