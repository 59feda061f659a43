// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/points.h"

namespace cdprep {

/// Returns points_inside() of a balanced model with triangles, computed through an octree or a
/// tetra-tree.
[[nodiscard]] Inclusion inclusion_by_cells(const Model& model, const Double3& p,
                                           Workspace& workspace, Structure through) noexcept;

}  // namespace cdprep
