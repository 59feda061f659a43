// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep {

/// Proves, of a file in which format::find_deep_damage() finds nothing, that the hulls around
/// nodes of its hierarchy over pieces hold every vertex below, exactly, and stick out of what
/// is below by no more than they say, up to the rounding of double. Returns nothing when all is
/// well, also without pieces. O(vertices * levels) hull questions; allocates. `model` is this
/// file, opened with all its sections.
[[nodiscard]] std::optional<format::Damage> find_piece_falsehood(std::span<const std::byte> file,
                                                                 const Model& model);

}  // namespace cdprep
