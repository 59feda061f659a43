// SPDX-License-Identifier: MIT
#include "cdprep/model_pieces.h"

#include <cassert>

#include "piece_parts.h"

namespace cdprep {

FeatureHull feature_hull(const Model& model, std::uint32_t piece) noexcept {
    assert(piece < model.pieces().size());
    FeatureHull hull;
    hull.points.corners =
        part_of_piece(model.piece_vertices(), model, piece, &format::Piece::first_vertex);
    hull.points.count = static_cast<std::uint32_t>(hull.points.corners.size());
    hull.points.floats = model.positions_f32();
    hull.points.doubles = model.positions_f64();
    if (model.piece_adjacency().size() != model.piece_facets().size()) return hull;
    hull.facets = part_of_piece(model.piece_facets(), model, piece, &format::Piece::first_facet);
    hull.adjacency =
        part_of_piece(model.piece_adjacency(), model, piece, &format::Piece::first_facet);
    return hull;
}

}  // namespace cdprep
