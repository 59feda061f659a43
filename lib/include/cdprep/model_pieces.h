// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/closest_features.h"
#include "cdprep/model.h"

namespace cdprep {

/// Returns the hull of a convex piece of a model's surface as closest_features() wants it, in the
/// file: valid as long as the model. Its points are the vertices that pieces().vertices lists for
/// the piece, in that order; its facets and their corners are numbered within the piece.
///
/// `piece` is below model.pieces().pieces.size(), and the model was baked with the effect
/// "contacts"; of another, which has no pieces().adjacency, the hull has no surface and serves as a
/// set of points. O(1).
[[nodiscard]] FeatureHull feature_hull(const Model& model, std::uint32_t piece) noexcept;

}  // namespace cdprep
