// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cdprep/exact/triangles.h"
#include "crossings/self_intersections.h"

namespace cdprep::mesh {

/// How two triangles without a common vertex meet, or nothing. Both have area.
[[nodiscard]] std::optional<Meeting> meeting_apart(const Corners& a, const Corners& b) noexcept;

/// The same of two whose insides are known to cross.
[[nodiscard]] Meeting meeting_across(const Corners& a, const Corners& b) noexcept;

/// How two triangles whose first corners are one vertex, and no others, meet elsewhere, or
/// nothing. Both have area.
[[nodiscard]] std::optional<Meeting> meeting_at_corner(const Corners& a, const Corners& b) noexcept;

/// How two triangles whose first two corners are the same two vertices, in either order,
/// and whose third are not, meet elsewhere, or nothing. Both have area.
[[nodiscard]] std::optional<Meeting> meeting_at_edge(const Corners& a, const Corners& b) noexcept;

}  // namespace cdprep::mesh
