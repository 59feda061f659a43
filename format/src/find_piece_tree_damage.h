// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/find_damage.h"

namespace cdprep::format {

/// Of a file whose table lies inside it: a hierarchy over pieces of which a part is missing, or
/// without pieces. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_piece_tree(
    std::span<const std::byte> file) noexcept;

/// Of a file without missing sections, whose pieces are sound if `wanted` holds them: proves that
/// the hierarchy over them, if it has one and `wanted` holds sections 50, 51, 54 to 56 and 61, has
/// as many nodes and hulls as its leaves want, leaves that are runs of their piece's triangles, as
/// many as the model has, and hulls with finite corners. Whether boxes and hulls hold what is
/// below them is not looked at.
[[nodiscard]] std::optional<Damage> find_piece_tree_damage(std::span<const std::byte> file,
                                                           SectionSet wanted) noexcept;

}  // namespace cdprep::format
