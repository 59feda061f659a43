// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/find_damage.h"

namespace cdprep::format {

/// Of a file whose table lies inside it: an adaptive octree of which a part is missing, or
/// the triangles. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_adaptive_octree(
    std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves the adaptive octree, if it has one and
/// `wanted` holds sections 33 to 35, to be a tree no deeper than it says, with links that
/// lead forward, splits inside the boxes that follow from those above, and leaves whose lists
/// hold numbers of triangles, rising. Whether leaves list the triangles that touch them is
/// not looked at.
[[nodiscard]] std::optional<Damage> find_adaptive_octree_damage(std::span<const std::byte> file,
                                                                SectionSet wanted) noexcept;

}  // namespace cdprep::format
