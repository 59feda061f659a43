// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep {

/// Proves, beyond format::find_deep_damage(), which has found nothing in this file, that the
/// leaves of its octrees and its tetra-tree list exactly the triangles that have a point in
/// their closed cells or cones, that references are marked as shared where they are, that an
/// octree's root holds every corner, and that its tables find every node. Exact: each triangle
/// is held against the cells by signs that no rounding changes. A tetra-tree's radii that leave
/// out more than rounding can account for are damage too, where a cone's planes cut a triangle
/// more than a millionth of the part that is left. Returns nothing when all is well, also without
/// any of them. O(triangles * levels), a microsecond or so each; allocates. `model` is this file,
/// opened with all its sections.
[[nodiscard]] std::optional<format::Damage> find_list_damage(std::span<const std::byte> file,
                                                             const Model& model);

}  // namespace cdprep
