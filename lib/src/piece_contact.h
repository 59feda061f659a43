// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/overlapping_triangles.h"
#include "cdprep/piece_cache.h"

namespace cdprep {

/// The corners of a hull around a node, as questions about hulls want them.
[[nodiscard]] ConvexPoints hull_points(const format::PieceNodeHull& hull) noexcept;

/// Returns whether the hulls around all pieces of two models prove that the surfaces are more
/// than `distance` apart, which is not negative; false when they do not, or when they are not
/// asked because they have failed of late. Counts the question.
[[nodiscard]] bool hulls_prove_apart(const Model& a, const Model& b, const Placement& placement,
                                     double distance, PieceCache& cache,
                                     QueryCounts* counts) noexcept;

/// As any_contact(), through pieces.
[[nodiscard]] bool any_contact_of_pieces(const Model& a, const Model& b, const Placement& placement,
                                         Workspace& workspace, const OverlapOptions& options,
                                         PieceCache* cache) noexcept;

}  // namespace cdprep
