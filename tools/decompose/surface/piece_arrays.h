// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/format/pieces.h"
#include "decompose/surface/surface_pieces.h"

namespace cdprep::convex {

/// Pieces as a baked file stores them (format/pieces.h).
struct PieceArrays {
    std::vector<format::Piece> pieces;
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> vertices;
    std::vector<format::PieceFacet> facets;
};

/// Makes the hull of every piece of a mesh, and finds exactly which hull faces are covered by
/// triangles of the piece. With a tolerance, few faces are. The same for any parallel_for.
[[nodiscard]] PieceArrays make_piece_arrays(const mesh::Mesh& mesh, SurfacePieces pieces,
                                            ParallelFor parallel_for);

}  // namespace cdprep::convex
