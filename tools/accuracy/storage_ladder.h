// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "accuracy/ladder.h"

namespace cdprep::study {

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
