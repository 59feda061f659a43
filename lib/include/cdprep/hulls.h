// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "cdprep/advanced/closest_features.h"
#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/advanced/convex_points.h"
#include "cdprep/model.h"

namespace cdprep {

/// Returns the number, in Model::hulls().hulls, of the hull around the whole of a model, around a
/// component, an instance or a part; nothing when it has none. `number` is 0 for the
/// whole. Parts are the last hulls, from number 0 on: no point of the model is outside all
/// of them. Needs Ask::hulls. Takes O(log n) time.
[[nodiscard]] std::optional<std::uint32_t> find_hull(const Model& model, format::HullScope scope,
                                                     std::uint32_t number = 0) noexcept;

/// Returns the corners of a hull as queries want them, in the file: valid as long as the
/// model. Needs Ask::hulls. `hull` is below model.hulls().hulls.size(). One of nothing has the
/// count 0.
[[nodiscard]] ConvexPoints convex_points(const Model& model, std::uint32_t hull) noexcept;

/// Returns the corners of the hull of a convex piece of a model's surface as queries want them, in
/// the file: valid as long as the model. They are the vertices that pieces().vertices lists for the
/// piece, in that order. `piece` is below model.pieces().pieces.size(). Needs Ask::pieces. Takes
/// O(1) time.
[[nodiscard]] ConvexPoints piece_points(const Model& model, std::uint32_t piece) noexcept;

/// Returns the same hull with its surface, as closest_features() wants it. Its points are those of
/// piece_points(); its facets and their corners are numbered within the piece. Needs
/// Ask::contacts. Takes O(1) time.
[[nodiscard]] FeatureHull feature_hull(const Model& model, std::uint32_t piece) noexcept;

}  // namespace cdprep
