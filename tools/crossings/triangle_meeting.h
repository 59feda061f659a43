// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cdprep/exact/triangles.h"
#include "crossings/self_intersections.h"

namespace cdprep::mesh {

[[nodiscard]] inline Corners corners_of(const Mesh& mesh, std::uint32_t triangle) {
    const auto& v = mesh.triangles[triangle].vertex;
    return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

/// Returns the meeting of two triangles without a common vertex, or nothing. Both must have
/// area.
[[nodiscard]] std::optional<Meeting> meeting_apart(const Corners& a, const Corners& b) noexcept;

/// Returns the same for two triangles whose interiors are known to cross.
[[nodiscard]] Meeting meeting_across(const Corners& a, const Corners& b) noexcept;

/// Returns the meeting of two triangles outside their common first corner, or nothing. They must
/// share that vertex only, and both must have area.
[[nodiscard]] std::optional<Meeting> meeting_at_corner(const Corners& a, const Corners& b) noexcept;

/// Returns the meeting of two triangles outside their common edge, or nothing. Their first two
/// corners must be the same two vertices, in either order, and their third corners must differ.
/// Both must have area.
[[nodiscard]] std::optional<Meeting> meeting_at_edge(const Corners& a, const Corners& b) noexcept;

}  // namespace cdprep::mesh
