// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "hull/convex_hull.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// The set of triangles that a hull encloses.
enum class HullScope : std::uint8_t {
    whole,      ///< the whole mesh
    component,  ///< triangles connected by shared vertices
    node,       ///< each instance of the imported file; the whole mesh if there are none
};

struct MeshHullOptions {
    HullScope scope = HullScope::whole;
    std::uint32_t max_vertices = 0;  ///< 0: exact hulls; else at least kFewestEnclosingVertices
    ParallelFor parallel_for = serial_for;
};

struct MeshHull {
    /// Its numbers are vertices of the mesh; empty if it encloses the exact hull.
    ConvexHull hull;
    double distance = 0;  ///< EnclosingHull::distance, model units
};

/// Returns the hulls of a mesh: one in total; one per component, in order of their first
/// triangles; or one per instance, in order. A hull of no triangles has dimension -1. Returns
/// nothing if an enclosing hull would leave the range of double.
[[nodiscard]] std::optional<std::vector<MeshHull>> find_mesh_hulls(
    const mesh::Mesh& mesh, std::span<const format::Instance> instances,
    const MeshHullOptions& options);

}  // namespace cdprep::convex
