// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep {

/// Proves that the stored hulls of a file are convex hulls. Returns nothing if they are, or if
/// there are none.
///
/// Six properties are checked, with exact signs. Every edge is convex, or flat between facets of
/// one coplanar group. If the file has source_vertex, the points of exact hulls equal the vertices
/// that hull_vertices names. The stored neighbours of a point are the ends of its facets' edges. No
/// vertex lies in front of a facet of the whole model's hull. No point of any other hull lies in
/// front of one of its facets. If there are parts, each vertex is in at least one.
///
/// Three properties are not checked. Vertices of a component or an instance may lie outside its
/// hull. Vertices may lie outside a hull that is a segment, or beside a polygon, in its plane. A
/// triangle whose corners lie in different parts may have points that lie in no part. The last
/// check requires exact numbers of any length (tools/info/find_cover_falsehood.h).
///
/// format::find_damage() must find nothing in `file`. `model` is this file, opened with all its
/// sections. Takes O(vertices * facets) time, about a nanosecond per pair of a vertex and a facet.
/// If there are parts, takes up to vertices * parts steps more. Allocates.
[[nodiscard]] CDPREP_API std::optional<format::Damage> find_hull_falsehood(
    std::span<const std::byte> file, const Model& model);

/// Proves that the hulls around the nodes of the BVH over pieces are correct. Each hull contains
/// every vertex below its node; this check is exact. Each corner of a hull is within
/// PieceNodeHull::slack of the exact hull of these vertices, up to rounding. Returns nothing if all
/// are correct, or if there are no pieces.
///
/// format::find_deep_damage() must find nothing in `file`. `model` is this file, opened with all
/// its sections. Takes O(vertices * levels) hull queries. Allocates.
[[nodiscard]] CDPREP_API std::optional<format::Damage> find_piece_falsehood(
    std::span<const std::byte> file, const Model& model);

}  // namespace cdprep
