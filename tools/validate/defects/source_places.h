// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "validate/defects/edge_flaws.h"
#include "validate/defects/finding.h"
#include "validate/defects/sound_mesh.h"

namespace cdprep::mesh {

/// The limit on vertices or triangles of one place: the path along a long hole is cut there.
inline constexpr std::size_t kMaxPlaceNumbers = 1000;

/// Returns the file's number of a mesh vertex, as the triangle uses it for a corner.
[[nodiscard]] std::uint32_t source_corner(const TriangleSoup& soup, const SoundMesh& sound,
                                          std::uint32_t triangle, std::uint32_t vertex);

/// Returns the middle of two points.
[[nodiscard]] Double3 middle_of(const Double3& a, const Double3& b);

/// Returns the place of an edge: its lowest triangle, its ends, its middle.
[[nodiscard]] Place place_of_edge(const TriangleSoup& soup, const SoundMesh& sound,
                                  const FlawedEdge& edge, double measure);

/// Compares edges by their lowest triangle.
[[nodiscard]] bool comes_before(const FlawedEdge& a, const FlawedEdge& b);

}  // namespace cdprep::mesh
