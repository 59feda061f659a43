// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep {

/// Proves, of a file in which format::find_damage() finds nothing, that its hulls are hulls:
/// every edge convex, or flat within a group, by exact signs; points of exact hulls the
/// vertices that they name; neighbours those of the facets; no point in front of a facet,
/// nor any vertex in front of one of the whole's; every vertex in one part or more, exactly,
/// where there are parts. Not looked at: vertices of a component or an instance beside its hull,
/// those beside a segment or a polygon in its plane, and whether a triangle with corners in
/// several parts leaves them all in between, for which exact numbers of any length are needed
/// (tools/info/find_cover_falsehood.h). Returns nothing when all is well, also without hulls.
/// O(vertices * facets), about a nanosecond each, and up to vertices * parts steps; allocates.
/// `model` is this file, opened with all its sections.
[[nodiscard]] std::optional<format::Damage> find_hull_falsehood(std::span<const std::byte> file,
                                                                const Model& model);

/// Proves, of a file in which format::find_deep_damage() finds nothing, that the hulls around
/// nodes of its hierarchy over pieces hold every vertex below, exactly, and stick out of what
/// is below by no more than they say, up to the rounding of double. Returns nothing when all is
/// well, also without pieces. O(vertices * levels) hull questions; allocates. `model` is this
/// file, opened with all its sections.
[[nodiscard]] std::optional<format::Damage> find_piece_falsehood(std::span<const std::byte> file,
                                                                 const Model& model);

}  // namespace cdprep
