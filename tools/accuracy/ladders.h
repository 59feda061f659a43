// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "accuracy/ladder.h"

namespace cdprep::study {

/// The distance between the models, with smaller and smaller permitted errors, and between their
/// hulls. Runs over the poses that do not touch. Every interval promises to contain the truth.
[[nodiscard]] Ladder climb_distance(const Climb& climb, Broken& broken);

/// The test whether two triangles touch, with more and more precise arithmetic. Runs over the pairs
/// of triangles that touch or are at most 1e-4 diagonals apart.
[[nodiscard]] Ladder climb_predicates(const Climb& climb, Broken& broken);

/// The same exact queries, cold (nothing of the models in the processor's caches), warm, and with a
/// PairCache. They run along walks on which B moves by 1/1000 of the diagonal and turns by 0.2
/// degrees per frame. Only the time differs: every answer promises to be exact.
[[nodiscard]] Ladder climb_coherence(const Climb& climb, std::uint64_t last_cache, Broken& broken);

/// The test whether the models touch, with tighter and tighter shapes around them. The shapes are a
/// sphere, boxes, the hull, enclosing parts, and levels of a tetra-tree and of an octree. The last
/// rungs are the BVH in float without its exact stage, and with it. All shapes enclose the models,
/// so they promise no misses.
[[nodiscard]] Ladder climb_geometry(const Climb& climb, Broken& broken);

/// The test whether the models touch, and which triangles do, if vertices have fewer bits. They are
/// on a grid over each model's box, floats, or doubles.
[[nodiscard]] Ladder climb_storage(const Climb& climb, Broken& broken);

/// Returns the mesh with its vertices moved to the nearest points of a grid. The grid has 2^bits
/// planes along each axis of the cube around the mesh.
[[nodiscard]] mesh::Mesh on_grid(const mesh::Mesh& mesh, unsigned bits);

/// Returns whether all coordinates are far enough within the range of float. They then stay in it
/// if the mesh is rotated and moved around another one of its size.
[[nodiscard]] bool fits_float(const mesh::Mesh& mesh) noexcept;

}  // namespace cdprep::study
