// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/find_damage.h"

namespace cdprep::format {

/// Of a file whose table lies inside it: a tetra-tree of which a part is missing, or the
/// triangles. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_tetra(std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves the tetra-tree, if it has one and `wanted`
/// holds sections 36 to 39, to be a tree no deeper than it says, whose keys continue their
/// parents', with lists that hold numbers of triangles, rising, radii that are in order, and
/// a table that says what the nodes say. Whether leaves list the triangles that touch them is
/// not looked at.
[[nodiscard]] std::optional<Damage> find_tetra_damage(std::span<const std::byte> file,
                                                      SectionSet wanted) noexcept;

}  // namespace cdprep::format
