// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "accuracy/ladder.h"

namespace cdprep::study {

/// How far apart the models are, with permitted errors that shrink, and by their hulls alone.
/// Over the poses that do not touch. Every interval promises to hold the truth.
[[nodiscard]] Ladder climb_distance(const Climb& climb, Broken& broken);

/// Whether two triangles touch, by arithmetic that gets wider, over the pairs that the float
/// stage leaves open or calls crossing and those that are as near as 1e-4 diagonals.
[[nodiscard]] Ladder climb_predicates(const Climb& climb, Broken& broken);

/// The same exact questions asked cold (nothing of the models in the processor's caches), warm,
/// and with a PairCache, along walks on which B moves by 1/1000 of the diagonal and turns by
/// 0.2 degrees a frame. Only time differs: every answer promises to be exact.
[[nodiscard]] Ladder climb_coherence(const Climb& climb, std::uint64_t last_cache, Broken& broken);

/// Whether the models touch, by shapes around them that fit better and better: a sphere, boxes,
/// the hull, convex pieces, levels of a tetra-tree and of an octree, the hierarchy of boxes in
/// float without its exact stage, and with it. All shapes enclose, so they promise not to miss.
[[nodiscard]] Ladder climb_geometry(const Climb& climb, Broken& broken);

/// Whether the models touch, and which triangles do, when vertices are stored with fewer bits:
/// on a grid over each model's box, as floats, as doubles.
[[nodiscard]] Ladder climb_storage(const Climb& climb, Broken& broken);

/// Vertices on the nearest points of a grid of 2^bits planes along each axis, over the cube
/// around the mesh.
[[nodiscard]] mesh::Mesh on_grid(const mesh::Mesh& mesh, unsigned bits);

/// Whether all coordinates are so far within the range of float that they stay there when
/// the mesh is turned and moved about another one of its size.
[[nodiscard]] bool fits_float(const mesh::Mesh& mesh) noexcept;

}  // namespace cdprep::study
