// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "cdprep/workspace.h"
#include "study/source_triangles.h"

namespace cdprep::study {

/// Returns a bound of the error of transform_point() for the vertices of `b`, along an axis, in
/// model units. The exact result is the rotation by the quaternion that `a_from_b` was made from.
[[nodiscard]] double rounding_of_pose(const Model& b, const Pose& a_from_b) noexcept;

/// Returns whether surfaces at least `gap` apart at level E1 (transform_point()) are proved to be
/// apart at level E3 (the exact rotation) too.
[[nodiscard]] bool is_apart_when_rigid(const Model& b, const Pose& a_from_b, double gap) noexcept;

/// Returns whether some edge of one surface pierces some triangle of the other by so much that it
/// does after the exact rotation too. False proves nothing. Costs as much as an overlap query, or
/// much less if the first pairs decide.
[[nodiscard]] bool crosses_when_rigid(const SourceTriangles& a, const SourceTriangles& b,
                                      const Pose& a_from_b, Workspace& workspace);

}  // namespace cdprep::study
