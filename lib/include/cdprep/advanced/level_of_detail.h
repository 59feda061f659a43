// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/pose.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// What the facets of two tetra-trees say about two solids at one level of detail.
struct CoarseCollision {
    /// `no`: the solids, and so their surfaces, have no common point. `yes`: they have one.
    /// `unknown`: the facets of this level cannot tell.
    Answer answer = Answer::unknown;
    double error_a = 0;  ///< level_error() of A
    double error_b = 0;
};

/// Returns how far the outer and the inner facets of a level are apart at most, along any
/// ray from the tetra-tree's centre, model units: the error of a model at that level. Falls
/// as the level rises, to what the leaves have. 0 for a model without triangles. Needs
/// Ask::tetra_tree. O(cones of the level).
///
/// Level 0 has one outer and one inner facet an octant, level l four times as many as level
/// l - 1, where the tree is that deep; a cone that is not split stays as it is. The outer
/// facet of a cone cuts it off at its greatest radius, the inner at its least
/// (format::TetraNode): between them lie all triangles of the cone.
[[nodiscard]] double level_error(const Model& model, std::uint32_t level) noexcept;

/// Returns whether two solids collide, as far as one level of their tetra-trees tells.
/// Reads no options. Needs Ask::tetra_tree of both models.
///
/// Conservative: `no` when no two cones meet that are cut off at their outer facets; this
/// is right for open models too, as for surfaces. `yes` when a point is found below the
/// inner facets of both, or below those of one at the other's centre: only for closed
/// models whose centre is inside. Such points are sought at centres and under facets, so
/// `yes` may be missed where it is true. Never allocates. O(pairs of cones that meet).
[[nodiscard]] CoarseCollision collide_at_level(const Pair& pair, std::uint32_t level,
                                               Workspace& workspace) noexcept;

}  // namespace cdprep
