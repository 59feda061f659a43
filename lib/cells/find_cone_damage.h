// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep {

/// find_list_damage() for the tetra-tree: its leaves list exactly the triangles that have a
/// point in their closed cones, but for those that hold the centre, which come first.
/// Radii hold of them what surely lies in the cones (cone_reach.h), and boxes, where it has
/// those, the corners; where edges cross into a cone, boxes are not proved. Nothing without one.
[[nodiscard]] std::optional<format::Damage> find_cone_damage(std::span<const std::byte> file,
                                                             const Model& model);

}  // namespace cdprep
