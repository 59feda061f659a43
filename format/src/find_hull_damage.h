// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/find_damage.h"

namespace cdprep::format {

/// Of a file whose table lies inside it: hulls of which a part is missing. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_hulls(std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves its hulls, if it has any and `wanted` holds
/// sections 44 to 49 and 60, to be safe to query: parts without gaps, as many as the dimension
/// asks for, every point finite and within reach, facets that close, groups that follow
/// each other, neighbours and starts that are points. Whether they are hulls is not looked
/// at.
[[nodiscard]] std::optional<Damage> find_hull_damage(std::span<const std::byte> file,
                                                     SectionSet wanted) noexcept;

}  // namespace cdprep::format
