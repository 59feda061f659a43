// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/structure.h"
#include "cdprep/triangles_within.h"

namespace cdprep {

/// visit_triangles_within() in the numbering of the tree order, through Structure::pieces or,
/// for every other structure, the hierarchies of boxes.
bool visit_near_triangles(Structure structure, const Model& a, const Model& b,
                          const Placement& placement, double tolerance, Workspace& workspace,
                          PairVisitor visit, const WithinOptions& options) noexcept;

}  // namespace cdprep
