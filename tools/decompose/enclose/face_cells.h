// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "decompose/enclose/solid.h"
#include "decompose/enclose/solid_cells.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// Cuts bodies along the planes of their faces at reflex edges, in any orientation. The cells are
/// convex and lie in the solid, up to rounding. It suits prisms, blocks with slots, and plates with
/// holes of few sides. Vertices within 1e-6 of the diagonal of a plane count as on it.
///
/// Fragments and places are like those of cut_into_cells(); boxes bound cells. `is_wanted` is by
/// body; other bodies get no cells. Returns nothing if a limit is exceeded, a wanted body is not
/// closed and oriented, or a cell would not be convex. A body may have 4,000 triangles, and 32
/// planes of faces with reflex edges. All bodies together may have 128 cells. These limits bound
/// the work to some milliseconds.
[[nodiscard]] std::optional<SolidCells> cut_along_faces(const mesh::Mesh& mesh, const Solid& solid,
                                                        const std::vector<bool>& is_wanted);

}  // namespace cdprep::convex
