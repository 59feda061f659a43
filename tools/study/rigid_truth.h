// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "cdprep/workspace.h"
#include "study/source_triangles.h"

namespace cdprep::study {

/// Returns how far transform_point() puts a vertex of `b` at most from where the exact rotation by
/// the quaternion that `a_from_b` was made of puts it, along an axis, model units.
[[nodiscard]] double rounding_of_pose(const Model& b, const Pose& a_from_b) noexcept;

/// Whether it is proved that surfaces which are at least `gap` apart as transform_point() (level
/// E1) are apart after the exact rotation (level E3) too.
[[nodiscard]] bool is_apart_when_rigid(const Model& b, const Pose& a_from_b, double gap) noexcept;

/// Whether some edge of one surface goes through some triangle of the other by so much that
/// it does after the exact rotation too. False proves nothing. Costs as an overlap, much less
/// where the first pairs settle it.
[[nodiscard]] bool crosses_when_rigid(const SourceTriangles& a, const SourceTriangles& b,
                                      const Pose& a_from_b, Workspace& workspace);

}  // namespace cdprep::study
