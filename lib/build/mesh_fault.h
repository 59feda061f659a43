// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "cdprep/format/geometry.h"
#include "cdprep/result.h"

namespace cdprep::build {

/// Returns why positions cannot be those of a model: the first that is NaN, infinite or beyond
/// format::kMaxCoordinate. Allocates nothing if all are good.
[[nodiscard]] std::optional<Error> find_bad_position(std::span<const format::Double3> positions);
[[nodiscard]] std::optional<Error> find_bad_position(std::span<const format::Float3> positions);

/// Returns why triangles cannot be those of a model with `vertex_count` vertices.
[[nodiscard]] std::optional<Error> find_bad_triangle(std::size_t vertex_count,
                                                     std::span<const format::Triangle> triangles);

}  // namespace cdprep::build
