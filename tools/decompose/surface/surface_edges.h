// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/half_edges.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// How the surface bends at an edge, by exact signs, or why it does not continue there.
enum class EdgeKind : std::uint8_t {
    convex,        ///< the solid is locally convex
    flat,          ///< both triangles in one plane, side by side
    reflex,        ///< the solid is locally concave
    fold,          ///< both triangles in one plane, one over the other
    border,        ///< used by one triangle
    non_manifold,  ///< used by more than two triangles
    inconsistent,  ///< used by two triangles, in the same direction
    no_area        ///< of a triangle without area, or next to one
};
inline constexpr std::size_t kEdgeKinds = 8;

/// Returns true if pieces never cross such an edge. They cross convex and flat edges, and with a
/// tolerance also reflex ones.
[[nodiscard]] constexpr bool is_barrier(EdgeKind kind) noexcept {
    return kind > EdgeKind::reflex;
}

struct SurfaceEdges {
    std::vector<mesh::HalfEdge> twin;             ///< by half-edge; kNone at a barrier
    std::vector<EdgeKind> kind;                   ///< by half-edge
    std::array<std::size_t, kEdgeKinds> count{};  ///< edges of each kind, each counted once
};

/// Classifies every edge. Exact. The same for any parallel_for. O(n).
[[nodiscard]] SurfaceEdges find_surface_edges(const mesh::Mesh& mesh, ParallelFor parallel_for);

}  // namespace cdprep::convex
