// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/containment.h"
#include "cdprep/structure.h"

namespace cdprep {

/// Returns what points_inside() returns, bit for bit, through another structure of the file:
/// the tetra-tree looks at the triangles of one cone alone, those that a ray away from the
/// tree's centre may meet; the octrees look at those in the cells along a ray.
///
/// Any finite point may be asked for: in the plane of a face, behind an edge or a corner,
/// on a border of cells or cones, at the tree's centre. hashed_octree_literal answers as
/// hashed_octree: for one point the talk's search is right. points_inside() itself answers for a
/// model that is not closed, and for Structure::bvh and Structure::pieces. Needs Ask::inside
/// and ask_of() the structure.
///
/// As exact as points_inside(), never allocates. Costs O(level + triangles in one cone), or
/// O(cells along the ray + triangles in them); how many triangles these are is counted in
/// QueryCounts::ray_triangles.
[[nodiscard]] Inclusion includes_through(Structure structure, const Model& model, const Double3& p,
                                         Workspace& workspace) noexcept;

}  // namespace cdprep
