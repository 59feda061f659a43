// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/find_damage.h"

namespace cdprep::format {

/// Of a file whose table lies inside it: pieces of which a part is missing, or the triangles;
/// section 57 or 59 without pieces, convexity without triangles.
/// Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_pieces(std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves that pieces, if it has some and `wanted` holds
/// sections 50 to 53, follow each other, name triangles and vertices that there are, rising
/// within each, as many triangles as the model has, and facets over their own corners, which
/// agree with the dimension; and, if it holds sections 57 and 59 too, that the edges of those
/// facets are paired as it says, and triangles are in their pieces. Whether the hulls are those of
/// the triangles is not looked at.
[[nodiscard]] std::optional<Damage> find_piece_damage(std::span<const std::byte> file,
                                                      SectionSet wanted) noexcept;

}  // namespace cdprep::format
