// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"

namespace cdprep::format {

/// Of a file whose table lies inside it: an octree of which a part is missing, sections 25
/// to 27 or, where there is one of them, 28 to 32. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_octree(std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves the octree, if it has one and `wanted` holds
/// sections 25 to 27, to be a tree whose leaves hold numbers of triangles, and so that every
/// walk ends; and of sections 28 to 32 those that are wanted too: sorted leaves and their
/// table say what the nodes say, chains end and hold nodes of their own slot. Whether leaves
/// list the triangles that touch them is not looked at.
[[nodiscard]] std::optional<Damage> find_octree_damage(std::span<const std::byte> file,
                                                       SectionSet wanted) noexcept;

}  // namespace cdprep::format
