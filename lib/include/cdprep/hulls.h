// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "cdprep/advanced/closest_features.h"
#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/advanced/convex_points.h"
#include "cdprep/format/api.h"
#include "cdprep/model.h"

namespace cdprep {

/// Returns the index in Model::hulls().hulls of a hull around the whole model, a component, an
/// instance or a part. Returns nothing if the model has no such hull. `number` is 0 for the whole
/// model. Parts are at the end of the array, and `number` counts them from 0. Together they contain
/// the surface and its interior. Needs Ask::hulls. Takes O(log n) time.
[[nodiscard]] CDPREP_API std::optional<std::uint32_t> find_hull(const Model& model,
                                                                format::HullScope scope,
                                                                std::uint32_t number = 0) noexcept;

/// The parts that represent the solid of a model. Together they contain the solid.
struct EnclosingParts {
    std::uint32_t first = 0;  ///< part 0 in Model::hulls().hulls; the others follow
    std::uint32_t count = 0;  ///< 0: no parts represent the solid
    /// No point of a part is farther than this from the solid, model units.
    double error = 0;
    double size = 0;  ///< at least |x| + |y| + |z| of every point of a part, model units
};

/// Returns the parts that represent the solid of a model. Any model may be given. The result has no
/// parts if the model is a LiveModel, is not balanced, or was baked without parts. It also has none
/// if the sections of hulls or `components` were not opened. A model of several components has none
/// either: where they overlap, parts and winding numbers may disagree about the inside. Takes
/// O(parts) time.
[[nodiscard]] CDPREP_API EnclosingParts enclosing_parts(const Model& model) noexcept;

/// Returns the corners of a hull, as input for queries. They refer to the file's memory and are
/// valid as long as the model lives. Needs Ask::hulls. `hull` must be below
/// model.hulls().hulls.size(): otherwise the program stops with a message. The hull of an empty set
/// has the count 0.
[[nodiscard]] CDPREP_API ConvexPoints convex_points(const Model& model,
                                                    std::uint32_t hull) noexcept;

/// Returns the corners of a convex piece's hull, as input for queries. They refer to the file's
/// memory and are valid as long as the model lives. They are the vertices that pieces().vertices
/// lists for the piece, in that order. `piece` must be below model.pieces().pieces.size():
/// otherwise the program stops with a message. Needs Ask::pieces. Takes O(1) time.
[[nodiscard]] CDPREP_API ConvexPoints piece_points(const Model& model,
                                                   std::uint32_t piece) noexcept;

/// Returns the hull of a convex piece with its facets, for closest_features(). Its points are those
/// of piece_points(). Its facets and their corners are numbered within the piece. Needs
/// Ask::contacts. Takes O(1) time.
[[nodiscard]] CDPREP_API FeatureHull feature_hull(const Model& model, std::uint32_t piece) noexcept;

}  // namespace cdprep
