// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep::convex {

/// Proves, of a file in which find_hull_falsehood() finds nothing, that every point of every
/// triangle is in a part, where there are parts: exactly, on the numbers as stored. Of
/// triangles without area only corners are looked at, and parts that are points or segments
/// hold no others. Returns nothing when all is well, also without parts; else `found` is the
/// number of a triangle, in tree order, some point of which no part holds. `model` is this
/// file, opened with all its sections. Mostly O(triangles * facets of the parts around), some
/// nanoseconds each; microseconds for each facet that cuts a triangle that no part holds
/// whole. Allocates.
[[nodiscard]] std::optional<format::Damage> find_cover_falsehood(std::span<const std::byte> file,
                                                                 const Model& model);

}  // namespace cdprep::convex
