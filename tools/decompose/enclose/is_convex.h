// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "hull/convex_hull.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// Whether these triangles of a mesh are the surface of their hull: exact. They are when
/// none has a point of the hull in front of it along an edge (no edge is reflex), the
/// oriented uses of every edge cancel, and both enclose exactly the same volume; or all
/// that turned inside out.
[[nodiscard]] bool is_convex(const mesh::Mesh& mesh, std::span<const std::uint32_t> triangles,
                             const ConvexHull& hull);

}  // namespace cdprep::convex
