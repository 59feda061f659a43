// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/pose.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// The result of collide_at_level(), and the errors of its level.
struct CoarseCollision {
    /// `no`: the solids, and so their surfaces, have no common point. `yes`: the solids have one.
    /// `unknown`: the facets of this level do not decide.
    Answer answer = Answer::unknown;
    double error_a = 0;  ///< level_error() of A; 0 if either model has no triangles
    double error_b = 0;  ///< the same for B
};

/// Returns the error of a model at a level, in model units. It is an upper bound of the distance
/// between the outer and the inner facet of any cone. This distance is measured along rays from the
/// tetra-tree's centre. The bound is at most sqrt(3) times the greatest distance. The error never
/// rises with the level, and ends at the error of the leaves. The error is 0 for a model without
/// triangles. Needs Ask::tetra_tree. Takes O(cones of the level) time.
///
/// Level 0 has one outer and one inner facet per octant. Each further level splits every cone of
/// the tree into four; a leaf stays as it is. The outer facet cuts a cone at its greatest radius,
/// the inner one at its least (format::TetraNode). All parts of triangles in the cone lie between
/// these facets, except triangles that contain the centre. Beyond the deepest level, the facets are
/// those of the deepest level.
[[nodiscard]] CDPREP_API double level_error(const Model& model, std::uint32_t level) noexcept;

/// Returns whether two solids collide, if `level` of both tetra-trees can prove it. Ignores
/// pair.options. Needs Ask::tetra_tree of both models. The workspace must be made with cells().
///
/// `no`: no two cones meet within their outer facets. A `no` also holds for surfaces and for
/// unbalanced models. `yes`: a point lies below an inner facet of each model, towards the centre.
/// Both models must be balanced and contain the centre of their tetra-tree. The search tests only
/// the centres and a few points below each inner facet, so it may miss a `yes`. Never allocates.
/// Takes O(pairs of cones that meet) time.
[[nodiscard]] CDPREP_API CoarseCollision collide_at_level(const Pair& pair, std::uint32_t level,
                                                          Workspace& workspace) noexcept;

}  // namespace cdprep
