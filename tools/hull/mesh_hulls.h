// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "hull/convex_hull.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// What hulls are around.
enum class HullScope : std::uint8_t {
    whole,      ///< all of the mesh
    component,  ///< what shared vertices connect
    node,       ///< each instance of the imported file; the whole where it has none
};

struct MeshHullOptions {
    HullScope scope = HullScope::whole;
    std::uint32_t max_vertices = 0;  ///< 0: exact hulls; else at least kFewestEnclosingVertices
    ParallelFor parallel_for = serial_for;
};

struct MeshHull {
    /// Its numbers are vertices of the mesh; empty where it encloses the exact one.
    ConvexHull hull;
    double distance = 0;  ///< EnclosingHull::distance, model units
};

/// Returns the hulls of a mesh: one; one per component, in order of their first triangles;
/// or one per instance, in order. Of what has no triangles the dimension is -1. Nothing
/// when an enclosing hull would leave the range of double.
[[nodiscard]] std::optional<std::vector<MeshHull>> find_mesh_hulls(
    const mesh::Mesh& mesh, std::span<const format::Instance> instances,
    const MeshHullOptions& options);

}  // namespace cdprep::convex
