// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/convex_points.h"
#include "cdprep/advanced/pair_front.h"
#include "cdprep/format/pieces.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// Returns the corners of a hull around a node in the form for hull queries.
[[nodiscard]] ConvexPoints hull_points(const format::PieceNodeHull& hull) noexcept;

/// Returns the result of any_contact(), computed through pieces.
[[nodiscard]] bool any_contact_of_pieces(const Model& a, const Model& b, const Placement& placement,
                                         Workspace& workspace, const PairOptions& options,
                                         PairCache* cache) noexcept;

}  // namespace cdprep
