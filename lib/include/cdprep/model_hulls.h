// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "cdprep/convex_points.h"
#include "cdprep/model.h"

namespace cdprep {

/// Returns the number, in Model::hulls().hulls, of the hull around the whole of a model, around a
/// component, an instance or a part; nothing when it has none. `number` is 0 for the
/// whole. Parts are the last hulls, from number 0 on: no point of the model is outside all
/// of them. Needs Ask::hulls. O(log n).
[[nodiscard]] std::optional<std::uint32_t> find_hull(const Model& model, format::HullScope scope,
                                                     std::uint32_t number = 0) noexcept;

/// Returns the corners of a hull as queries want them, in the file: valid as long as the
/// model. Needs Ask::hulls. `hull` is below model.hulls().hulls.size(). One of nothing has the
/// count 0.
[[nodiscard]] ConvexPoints convex_points(const Model& model, std::uint32_t hull) noexcept;

}  // namespace cdprep
