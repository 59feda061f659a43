// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "hull/convex_hull.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// Returns true if these triangles of a mesh are the surface of their hull. Exact. Three conditions
/// decide. The oriented uses of every edge cancel. Every triangle with area is part of a face of
/// the hull, and all face outwards, or all inwards. Triangles and hull enclose exactly the same
/// volume. A surface turned inside out counts too. Returns false if triangles without area separate
/// others from all corners of their face.
///
/// Proof. The edges cancel, so the triangles cover all points of the hull's surface equally often:
/// the cover cannot change but at an edge. The volume is that of the hull, so it is once.
[[nodiscard]] bool is_convex(const mesh::Mesh& mesh, std::span<const std::uint32_t> triangles,
                             const ConvexHull& hull);

}  // namespace cdprep::convex
