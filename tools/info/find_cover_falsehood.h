// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep::convex {

/// Proves that every point of every triangle lies in an enclosing part: exactly, for the stored
/// numbers. Returns nothing if this is true, or if the file has no parts. Otherwise, `found` is the
/// number, in tree order, of a triangle with a point outside all parts.
///
/// Triangles without area are skipped: find_hull_falsehood() checks their corners. Parts that are
/// points or segments are skipped too: they cannot contain a triangle with area. `file` must be one
/// in which find_hull_falsehood() finds nothing; `model` is this file, opened with all its
/// sections.
///
/// Mostly takes O(triangles * facets of the parts around) time, some nanoseconds each. If no part
/// contains a whole triangle, each facet that cuts it takes microseconds. Allocates.
[[nodiscard]] std::optional<format::Damage> find_cover_falsehood(std::span<const std::byte> file,
                                                                 const Model& model);

}  // namespace cdprep::convex
