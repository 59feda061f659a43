// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/format/geometry.h"
#include "cdprep/result.h"

namespace cdprep::build {

/// Returns why positions cannot be those of a model: the first that is NaN, infinite or beyond
/// format::kMaxCoordinate. `vertices` are the numbers of their vertices, for the message; empty: 0,
/// 1, 2 and so on. Allocates nothing if all are good.
[[nodiscard]] std::optional<Error> find_bad_position(std::span<const format::Double3> positions,
                                                     std::span<const std::uint32_t> vertices = {});
[[nodiscard]] std::optional<Error> find_bad_position(std::span<const format::Float3> positions,
                                                     std::span<const std::uint32_t> vertices = {});

/// Returns why triangles cannot be those of a model with `vertex_count` vertices.
[[nodiscard]] std::optional<Error> find_bad_triangle(std::size_t vertex_count,
                                                     std::span<const format::Triangle> triangles);

}  // namespace cdprep::build
