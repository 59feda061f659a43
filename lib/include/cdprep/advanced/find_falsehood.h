// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep {

/// Proves that the hulls of a file are hulls. Returns nothing if they are, or if there are none.
///
/// Every edge is convex, or flat within a group, by exact signs. The points of exact hulls are the
/// vertices that they name. Neighbours are those of the facets. No point lies in front of a facet,
/// and no vertex in front of a facet of the whole's hull. If there are parts, each vertex is in at
/// least one, exactly.
///
/// Three properties are not checked. Vertices of a component or an instance may lie outside its
/// hull. Vertices may lie outside a segment, or outside a polygon in its plane. A triangle with
/// corners in several parts may leave them all in between. The last check needs exact numbers of
/// any length (tools/info/find_cover_falsehood.h).
///
/// `file` must be one in which format::find_damage() finds nothing. `model` is this file, opened
/// with all its sections. Takes O(vertices * facets) time, about a nanosecond each, and up to
/// vertices * parts steps. Allocates.
[[nodiscard]] std::optional<format::Damage> find_hull_falsehood(std::span<const std::byte> file,
                                                                const Model& model);

/// Proves that the hulls around the nodes of the BVH over pieces are right. Each contains every
/// vertex below its node, exactly. None exceeds what is below by more than its slack, up to the
/// rounding of double. Returns nothing if all are right, or if there are no pieces.
///
/// `file` must be one in which format::find_deep_damage() finds nothing. `model` is this file,
/// opened with all its sections. Takes O(vertices * levels) hull queries. Allocates.
[[nodiscard]] std::optional<format::Damage> find_piece_falsehood(std::span<const std::byte> file,
                                                                 const Model& model);

}  // namespace cdprep
