// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "decompose/enclose/solid.h"
#include "decompose/enclose/solid_cells.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

struct FaceCellOptions {
    std::size_t most_triangles = 4'000;  ///< of a body
    std::size_t most_planes = 32;        ///< of a body's faces with reflex edges
    std::size_t most_cells = 128;        ///< in all
};

/// Cuts bodies along the planes of their faces at reflex edges, whichever way these are
/// turned, into cells that are convex and lie in the solid, but for rounding: prisms, blocks
/// with slots, plates with holes of few sides. Vertices within 1e-6 of the diagonal of a
/// plane are on it. Fragments and places as cut_into_cells() makes them; boxes bound cells.
/// `is_wanted` is by body; others have no cells. Nothing where there is more than the
/// options allow, where a body is not closed and oriented, and where a cell would not be
/// convex. Limits bound the work: some milliseconds.
[[nodiscard]] std::optional<SolidCells> cut_along_faces(const mesh::Mesh& mesh, const Solid& solid,
                                                        const std::vector<bool>& is_wanted,
                                                        const FaceCellOptions& options = {});

}  // namespace cdprep::convex
