// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/convex_points.h"
#include "cdprep/format/pieces.h"
#include "cdprep/overlapping_triangles.h"
#include "cdprep/piece_cache.h"

namespace cdprep {

/// The corners of a hull around a node, as questions about hulls want them.
[[nodiscard]] ConvexPoints hull_points(const format::PieceNodeHull& hull) noexcept;

/// As any_contact(), through pieces.
[[nodiscard]] bool any_contact_of_pieces(const Model& a, const Model& b, const Placement& placement,
                                         Workspace& workspace, const OverlapOptions& options,
                                         PieceCache* cache) noexcept;

}  // namespace cdprep
