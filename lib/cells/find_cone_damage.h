// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep {

/// Returns damage in the lists of the tetra-tree, as find_list_damage() does. Returns nothing if
/// there is none or the model has no tetra-tree. Leaves must list exactly the triangles that have a
/// point in their closed cones. Triangles that hold the centre are excepted; they come first. Radii
/// must contain what certainly lies in the cones (cone_reach.h). Boxes, if present, must contain
/// the corners; they are not proved where edges cross into a cone.
[[nodiscard]] std::optional<format::Damage> find_cone_damage(std::span<const std::byte> file,
                                                             const Model& model);

}  // namespace cdprep
