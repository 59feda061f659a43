// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/triangles_within.h"

namespace cdprep {

/// visit_triangles_within() in the numbering of the tree order.
bool visit_near_triangles(const Model& a, const Model& b, const Placement& placement,
                          double tolerance, Workspace& workspace, PairVisitor visit,
                          const WithinOptions& options) noexcept;

}  // namespace cdprep
